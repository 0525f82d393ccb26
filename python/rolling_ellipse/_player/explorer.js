// The player with a blow to move over the body: a table of motions, one for each place and
// strength. It needs track.js, strip.js and player.js.

const STROBES = 8;
const BESIDE = `
  canvas { touch-action: none }
  .hands, .beside { display: flex; flex-wrap: wrap; gap: 6px 16px; padding: 6px 12px }
  .hands label { display: flex; flex: 1 1 220px; align-items: center; gap: 8px }
  .hands input { flex: 1; accent-color: var(--plum) }
  .hands output { min-width: 5.5em; font-variant-numeric: tabular-nums; text-align: right }
  figure { flex: 1 1 300px; min-width: 0; margin: 0 }
  figure canvas { height: 210px; border-radius: 6px; background: var(--paper) }
  figure.map canvas { cursor: crosshair }
  figcaption { padding: 4px 2px }
  .chip { display: inline-block; width: 11px; height: 11px; margin: 0 5px 0 0; border-radius: 3px;
    border: 1px solid var(--grey) }
  .said { padding: 2px 14px 12px }
  .said p { margin: 4px 0; white-space: pre-line }
  .said b { font-size: 15px }
  .said button { border-color: var(--faint) }
  .note { color: var(--grey) }`;

export class Explorer extends Player {
  begin() {
    const { table, strips: [strip], first } = this.film;
    this.strip = strip;
    table.numbers = unpacked(table.columns);
    const most = table.F.at(-1), long = Math.max(strip.a, strip.b);
    this.length = (F) => (0.5 + (1.7 * F) / most) * long;
    this.strength = (length) => ((length / long - 0.5) / 1.7) * most;
    this.choose(...first);
  }

  build(shadow) {
    super.build(shadow);
    const { table } = this.film;
    shadow.querySelector("style").append(BESIDE);
    const slider = (name, values) => `<input type="range" class="${name}" min="0" step="1"
      max="${values.length - 1}">`;
    this.box.insertAdjacentHTML("beforeend", `<div class="hands"><label>where${
      slider("where", table.d)}<output></output></label><label>how hard${slider("hard", table.F)}
      <output></output></label></div><div class="beside"><figure class="map"><canvas role="img">
      </canvas><figcaption></figcaption></figure><figure class="plot"><canvas role="img"
      aria-label="Forces of the ground over time"></canvas><figcaption>normal force N and friction F
      of the ground, in weights</figcaption></figure></div><div class="said" aria-live="polite">
      </div>`);
    const find = (words) => this.box.querySelector(words);
    [this.where, this.hard] = [find(".where"), find(".hard")];
    [this.map, this.plot, this.said] = [find(".map canvas"), find(".plot canvas"), find(".said")];
    this.where.oninput = () => this.strike(Number(this.where.value), this.j);
    this.hard.oninput = () => this.strike(this.i, Number(this.hard.value));
    find(".map figcaption").innerHTML = [...new Set(table.outcomes)].sort().map((code) =>
      `<span style="white-space:nowrap;margin-right:12px"><span class="chip"
      style="background:${table.colours[code]}"></span>${table.names[code]}</span>`).join("");
    this.grab(this.canvas, (event) => this.holds(event), (event) => this.dragged(event));
    this.grab(this.map, () => true, (event) => this.pointed(event));
    this.describe();
  }

  /** Call `moved` for a pointer on a canvas from a press that `holds` accepts to its release. */
  grab(canvas, holds, moved) {
    let held = false;
    canvas.addEventListener("pointerdown", (event) => {
      held = holds(event);
      if (!held) return;
      canvas.setPointerCapture(event.pointerId);
      moved(event);
    });
    canvas.addEventListener("pointermove", (event) => {
      if (held) moved(event);
      else if (canvas === this.canvas) canvas.style.cursor = holds(event) ? "grab" : "";
    });
    const let_go = () => {
      if (held && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
      held = false;
    };
    canvas.addEventListener("pointerup", let_go);
    canvas.addEventListener("pointercancel", let_go);
  }

  /** Hand and point of the blow, in pixels. */
  hand(view) {
    const { x, z } = this.strip.motion.at(0), { d, F } = this.blow();
    return { x, z, F, top: view.at(x + d, z + this.length(F)), point: view.at(x + d, z) };
  }

  holds({ offsetX, offsetY }) {
    const { top: [u, v], point: [x, y] } = this.hand(this.views[0]);
    const [c, s, p, q] = [x - u, y - v, offsetX - u, offsetY - v];
    const part = Math.min(1, Math.max(0, (p * c + q * s) / (c * c + s * s)));
    return Math.hypot(p - part * c, q - part * s) < 26;
  }

  dragged({ offsetX, offsetY }) {
    const { x, z } = this.strip.motion.at(0), { clientWidth } = this.box;
    const [px, pz] = this.viewsOf([{ x }], clientWidth)[0].ground(offsetX, offsetY);
    this.strike(nearest(this.film.table.d, px - x),
      nearest(this.film.table.F, this.strength(pz - z)));
  }

  pointed({ offsetX, offsetY }) {
    const { d, F } = this.film.table, { left, top, across, up } = this.cells();
    const place = (part, count) => Math.min(count - 1, Math.max(0, Math.floor(part * count)));
    this.strike(place((offsetX - left) / across, d.length),
      place(1 - (offsetY - top) / up, F.length));
  }

  blow() {
    const { d, F } = this.film.table;
    return { d: d[this.i], F: F[this.j] };
  }

  choose(i, j) {
    const { table } = this.film, n = i * table.F.length + j;
    Object.assign(this, { i, j, n });
    const columns = Object.fromEntries(Object.entries(table.numbers).map(([name, values]) =>
      [name, values.subarray(table.ends[n - 1] ?? 0, table.ends[n])]));
    this.take(this.strip, columns);
    this.strip.events = table.events[n];
  }

  /** Show the motion after a blow, from its beginning. */
  strike(i, j) {
    this.pause();
    this.t = 0;
    if (i !== this.i || j !== this.j) {
      this.choose(i, j);
      this.marks();
      this.describe();
    }
    this.draw();
  }

  describe() {
    const { table } = this.film, { n } = this, { d, F } = this.blow();
    [this.where.value, this.hard.value] = [this.i, this.j];
    this.where.nextElementSibling.value = `d = ${round(d)} m`;
    this.hard.nextElementSibling.value = `F = ${round(F)} N s`;
    const name = table.names[table.outcomes[n]];
    const events = table.events[n].map(([t, kind]) => `${kind} at ${t.toPrecision(4)} s`);
    const more = events.length > 8 ? `, … ${events.length - 8} more` : "";
    const lines = [["b", `First it ${name}.`],
      ["p", table.reasons[n]], ["p", events.slice(0, 8).join(", ") + more],
      ["span", `Nearest of ${table.d.length} × ${table.F.length} blows that were computed. `],
      ["button", "copy as code"]];
    this.said.replaceChildren(...lines.map(([kind, words]) =>
      Object.assign(document.createElement(kind), { textContent: words })));
    this.said.querySelector("span").className = "note";
    this.said.querySelector("button").onclick = ({ currentTarget }) => this.copy(currentTarget);
    this.map.setAttribute("aria-label", `Map of outcomes; at ${round(d)} m and ${round(F)} N s the
      body ${name}`);
    this.host.dataset.blow = `${d} ${F}`;
  }

  async copy(button) {
    const { d, F } = this.blow();
    const lines = this.film.table.code.replace("{F}", F).replace("{d}", d);
    this.host.dataset.code = lines;
    try {
      await navigator.clipboard.writeText(lines);
      button.textContent = "copied";
    } catch { // a page that may not write there shows them instead
      const shown = Object.assign(document.createElement("pre"), { textContent: lines });
      button.replaceWith(shown);
      getSelection().selectAllChildren(shown);
    }
  }

  /** Draw over the body: the path of the motion, and the hand. */
  over(ink) {
    const { strip, colours, views: [view] } = this, end = strip.motion.end;
    ink.globalAlpha = 0.4;
    line(ink, colours.orange, 1.2, strip.points.map(([, x, z]) => view.at(x, z)));
    for (let k = 1; k <= STROBES; k++) {
      outline(ink, strip, strip.motion.at((k / STROBES) * end), view);
      ink.globalAlpha = 0.2 + (0.3 * k) / STROBES;
      stroke(ink, colours.blue, 1);
    }
    ink.globalAlpha = this.t > 0 ? 0.45 : 1;
    const { top, point, F } = this.hand(view);
    arrow(ink, colours.plum, top, point, 4);
    disc(ink, colours.plum, colours.paper, top, 9);
    text(ink, colours.plum, `${round(F)} N s`, top[0] + 15, top[1] + 4, "left");
    ink.globalAlpha = 1;
  }

  paint() {
    super.paint();
    if (!this.box.clientWidth || !this.map) return;
    this.paintMap(sized(this.map, this.map.clientHeight));
    this.paintPlot(sized(this.plot, this.plot.clientHeight));
  }

  cells() {
    const [left, top] = [52, 10];
    return { left, top, across: this.map.clientWidth - left - 12,
      up: this.map.clientHeight - top - 36 };
  }

  paintMap(ink) {
    const { table } = this.film, { d, F } = table, { left, top, across, up } = this.cells();
    const [wide, tall] = [across / d.length, up / F.length];
    const corner = (i, j) => [left + i * wide, top + up - (j + 1) * tall];
    table.outcomes.forEach((code, n) => {
      ink.fillStyle = table.colours[code];
      ink.fillRect(...corner(Math.floor(n / F.length), n % F.length), wide + 0.7, tall + 0.7);
    });
    for (const [style, width] of [[this.colours.paper, 5], [this.colours.ink, 2]]) {
      Object.assign(ink, { strokeStyle: style, lineWidth: width });
      ink.strokeRect(...corner(this.i, this.j), wide, tall);
    }
    const { grey } = this.colours;
    [0, (d.length - 1) / 2, d.length - 1].forEach((i) =>
      text(ink, grey, round(d[i]), left + (i + 0.5) * wide, top + up + 14, "center", 11));
    [0, F.length - 1].forEach((j) =>
      text(ink, grey, round(F[j]), left - 5, top + up - (j + 0.5) * tall + 4, "right", 11));
    text(ink, grey, "where the hand presses, d [m]", left + across / 2, top + up + 30, "center", 11);
    ink.save();
    ink.translate(14, top + up / 2);
    ink.rotate(-Math.PI / 2);
    text(ink, grey, "how hard, F [N s]", 0, 0, "center", 11);
    ink.restore();
  }

  paintPlot(ink) {
    const { strip, colours } = this, { t, normal_force: N, friction_force: F } = strip.motion;
    const [left, top] = [34, 12], across = this.plot.clientWidth - left - 14;
    const up = this.plot.clientHeight - top - 30, { weight } = strip, { end } = this.film;
    const all = [...N, ...F].map((force) => force / weight);
    const high = Math.min(5, Math.max(1.5, ...all)), low = Math.max(-3, Math.min(-0.5, ...all));
    const x = (time) => left + (time / end) * across;
    const y = (part) => top + up * ((high - Math.min(high, Math.max(low, part))) / (high - low));
    for (let part = Math.ceil(low); part <= high; part++) {
      line(ink, colours.faint, 1, [[left, y(part)], [left + across, y(part)]]);
      text(ink, colours.grey, round(part), left - 6, y(part) + 4, "right", 11);
    }
    text(ink, colours.grey, "0", left, top + up + 14, "center", 11);
    text(ink, colours.grey, `${round(end)} s`, left + across, top + up + 14, "right", 11);
    ink.lineJoin = "round";
    const curves = [[N, colours.blue, "N", 0], [F, colours.orange, "F", 18]];
    for (const [forces, colour, name, place] of curves) {
      line(ink, colour, 1.8, Array.from(t, (time, k) => [x(time), y(forces[k] / weight)]));
      text(ink, colour, name, left + across - 20 + place, top + 8);
    }
    const upright = (colour, time) => line(ink, colour, 1, [[x(time), top], [x(time), top + up]]);
    for (const [time, kind] of strip.events) if (kind === "impact") upright(colours.plum, time);
    upright(colours.ink, this.t);
  }
}

function nearest(values, value) {
  return values.reduce((best, each, i) =>
    (Math.abs(each - value) < Math.abs(values[best] - value) ? i : best), 0);
}
