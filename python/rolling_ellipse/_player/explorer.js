// The player with a blow to move over the body: a table of motions, one for each place and
// strength. It needs track.js, strip.js and player.js.

const STROBES = 8;
const STEPS = { // of place and strength, by a key on the map
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1],
  Home: [-99, 0], End: [99, 0], PageDown: [0, -4], PageUp: [0, 4],
};
const PARTS = 8; // lines between two samples of the forces

export class Explorer extends Player {
  begin() {
    const { table, strips: [strip], first, shape } = this.film;
    this.strip = strip;
    this.lowest = shape;
    table.numbers = unpacked(table.columns);
    const most = table.F.at(-1), long = Math.max(strip.a, strip.b);
    this.length = (F) => (0.5 + (1.7 * F) / most) * long;
    this.strength = (length) => ((length / long - 0.5) / 1.7) * most;
    this.choose(...first);
  }

  build(shadow) {
    super.build(shadow);
    const find = (words) => this.box.querySelector(words);
    [this.where, this.hard] = [find(".where"), find(".hard")];
    [this.map, this.plot] = [find(".map canvas"), find(".plot canvas")];
    this.where.oninput = () => this.strike(Number(this.where.value), this.j);
    this.hard.oninput = () => this.strike(this.i, Number(this.hard.value));
    find(".said button").onclick = ({ currentTarget }) => this.copy(currentTarget);
    this.grab(this.canvas, (event) => this.holds(event), (event) => this.dragged(event));
    const mouse = ({ pointerType }) => pointerType !== "touch"; // a finger taps the map
    this.grab(this.map, mouse, (event) => this.pointed(event));
    this.describe();
  }

  /** Leave their own keys to the sliders, and move the blow on the map. */
  key(event) {
    const { key, target } = event, step = STEPS[key];
    if (!step || event.ctrlKey || event.altKey || event.metaKey) return super.key(event);
    if (target === this.where || target === this.hard) return;
    if (target !== this.map) return super.key(event);
    event.preventDefault();
    const { d, F } = this.film.table, within = (i, { length }) =>
      Math.min(length - 1, Math.max(0, i));
    this.strike(within(this.i + step[0], d), within(this.j + step[1], F));
  }

  /** Call `moved` for a pointer from a press that `holds` accepts to its release, and for a tap. */
  grab(canvas, holds, moved) {
    let held = false;
    canvas.addEventListener("pointerdown", (event) => {
      held = holds(event);
      if (!held) return;
      canvas.setPointerCapture(event.pointerId);
      moved(event);
    });
    canvas.addEventListener("touchstart", (event) => { // a held finger does not scroll the page
      if (held && event.cancelable) event.preventDefault();
    }, { passive: false });
    canvas.addEventListener("pointermove", (event) => {
      if (held) moved(event);
      else if (canvas === this.canvas) canvas.style.cursor = holds(event) ? "grab" : "";
    });
    const let_go = (event) => {
      const tapped = !held && canvas === this.map && event.type === "pointerup";
      if (tapped) moved(event);
      if ((held || tapped) && !matchMedia("(prefers-reduced-motion: reduce)").matches) this.play();
      held = false;
    };
    canvas.addEventListener("pointerup", let_go);
    canvas.addEventListener("pointercancel", let_go);
  }

  /** Hand and point of the blow, in pixels. */
  hand(view) {
    const { x, z } = this.strip.motion.at(0), { d, F } = this.blow();
    return { F, top: view.at(x + d, z + this.length(F)), point: view.at(x + d, z) };
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
    this.curves = forces(this.strip.motion, this.strip.weight);
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

  /** Write what the blow does, and speak where it is; the reason only when another one holds. */
  describe() {
    const { table } = this.film, { n } = this, { d, F } = this.blow();
    const told = (sentences) => sentences.map((each) => this.say(...each)).join(" ");
    const events = table.events[n].map(([t, kind]) =>
      this.say("event", { event: this.say(kind), t }));
    if (events.length > 8) events.splice(8, events.length, this.say("more", {
      count: events.length - 8 }));
    const lines = [told(table.headlines[n]), told(table.reasons[n]), events.join(", ")];
    const said = this.box.querySelector(".said").children;
    lines.forEach((text, k) => { said[k].textContent = text; });
    const spoken = this.box.querySelector(".spoken");
    const kind = [...table.headlines[n], ...table.reasons[n]].map(([key]) => key).join();
    if (spoken.dataset.kind !== kind) spoken.textContent = `${lines[0]} ${lines[1]}`;
    spoken.dataset.kind = kind;
    [this.where.value, this.hard.value] = [this.i, this.j];
    this.where.nextElementSibling.value = this.say("place", { d });
    this.hard.nextElementSibling.value = this.say("strength", { F });
    const [place, strength] = [this.say("place_spoken", { d }), this.say("strength_spoken", { F })];
    this.where.setAttribute("aria-valuetext", place);
    this.hard.setAttribute("aria-valuetext", strength);
    this.map.setAttribute("aria-valuenow", n + 1);
    this.map.setAttribute("aria-valuetext",
      `${place}, ${strength}: ${this.say(table.names[table.outcomes[n]])}`);
    const [N, shear] = this.curves, peak = Math.max(N.most, shear.most, -shear.least);
    this.plot.setAttribute("aria-label", this.say("forces_spoken", { t: this.strip.motion.end,
      N_least: N.least, N_most: N.most, F_least: shear.least, F_most: shear.most }));
    const cut = Math.max(N.most, shear.most) > table.cut[1] || shear.least < table.cut[0];
    this.plot.nextElementSibling.textContent = this.say("forces")
      + (cut ? this.say("forces_cut", { peak }) : "");
    this.host.dataset.blow = `${d} ${F}`;
  }

  async copy(button) {
    const { d, F } = this.blow();
    const lines = this.film.table.code.replace("{F}", F).replace("{d}", d);
    this.host.dataset.code = lines;
    try {
      await navigator.clipboard.writeText(lines);
      button.textContent = this.say("copied");
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
    line(ink, colours.orange, 1.2, strip.trace.map(({ x, z }) => view.at(x, z)));
    for (let k = 1; k <= STROBES; k++) {
      outline(ink, strip, strip.motion.at((k / STROBES) * end), view);
      ink.globalAlpha = 0.2 + (0.3 * k) / STROBES;
      stroke(ink, colours.blue, 1);
    }
    ink.globalAlpha = 1;
    const { top, point: foot, F } = this.hand(view), words = `${round(F)} N s`;
    arrow(ink, colours.plum, top, foot, 4);
    disc(ink, colours.plum, colours.paper, top, 11);
    Object.assign(ink, { strokeStyle: colours.paper, lineWidth: 4, lineJoin: "round",
      font: "13px system-ui, sans-serif", textAlign: "left" });
    ink.strokeText(words, top[0] + 17, top[1] + 4);
    text(ink, colours.plum, words, top[0] + 17, top[1] + 4, "left");
  }

  paint() {
    const { clientWidth: width } = this.box, [left, right, , top] = this.strip.window;
    // The numbers of the ruler are 34 pixels high.
    this.film.shape = Math.max(this.lowest, top / (right - left) + 34 / width);
    super.paint();
    if (!width || !this.map) return;
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
    text(ink, grey, this.say("map_places"), left + across / 2, top + up + 30, "center", 11);
    ink.save();
    ink.translate(14, top + up / 2);
    ink.rotate(-Math.PI / 2);
    text(ink, grey, this.say("map_strengths"), 0, 0, "center", 11);
    ink.restore();
  }

  paintPlot(ink) {
    const { colours, curves } = this, { end, table: { cut, least: range } } = this.film;
    const [left, top] = [34, 18], across = this.plot.clientWidth - left - 14;
    const up = this.plot.clientHeight - top - 24;
    const high = Math.min(cut[1], Math.max(range[1], ...curves.map(({ most }) => most)));
    const low = Math.max(cut[0], Math.min(range[0], ...curves.map(({ least }) => least)));
    const x = (time) => left + (time / end) * across;
    const y = (part) => top + up * ((high - Math.min(high, Math.max(low, part))) / (high - low));
    for (let part = Math.ceil(low); part <= high; part++) {
      line(ink, colours.faint, 1, [[left, y(part)], [left + across, y(part)]]);
      text(ink, colours.grey, round(part), left - 6, y(part) + 4, "right", 11);
    }
    text(ink, colours.grey, "0", left, top + up + 16, "center", 11);
    text(ink, colours.grey, `${round(end)} s`, left + across, top + up + 16, "right", 11);
    ink.lineJoin = "round";
    [["N", colours.blue, []], ["F", colours.orange, [5, 3]]].forEach(([name, colour, dash], k) => {
      ink.setLineDash(dash);
      line(ink, colour, 1.8, curves[k].points.map(([time, force]) => [x(time), y(force)]));
      const place = left + across - 86 + 46 * k;
      line(ink, colour, 1.8, [[place, top - 9], [place + 22, top - 9]]);
      ink.setLineDash([]);
      text(ink, colours.ink, name, place + 31, top - 5);
    });
    const upright = (colour, time) => line(ink, colour, 1, [[x(time), top], [x(time), top + up]]);
    for (const [time, kind] of this.strip.events)
      if (kind === "impact") upright(colours.plum, time);
    upright(colours.ink, this.t);
  }
}

/** Both forces over time [s, weights]. */
function forces(motion, weight) {
  const states = motion.states(PARTS);
  return ["N", "F"].map((name) => {
    const points = states.map((at) => [at.t, at[name] / weight]);
    const values = points.map(([, force]) => Number(force.toFixed(3)));
    return { points, least: Math.min(...values), most: Math.max(...values) };
  });
}

function nearest(values, value) {
  return values.reduce((best, each, i) =>
    (Math.abs(each - value) < Math.abs(values[best] - value) ? i : best), 0);
}
