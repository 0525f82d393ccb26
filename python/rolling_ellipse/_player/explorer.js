// The player with a blow to move over the body: a table of motions, one for each place and
// strength. It needs track.js, strip.js, player.js and charts.js.

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
    [this.map, this.plot] = [find(".map canvas"), find(".plot canvas")];
    find(".copy").onclick = ({ currentTarget }) => this.copy(currentTarget, this.code());
    this.grab(this.canvas, (event) => this.holds(event), (event) => this.dragged(event));
    const mouse = ({ pointerType }) => pointerType !== "touch"; // a finger taps the map
    this.grab(this.map, mouse, (event) => this.pointed(event));
    this.hands(find);
    this.describe();
  }

  /** Connect the sliders of the page. */
  hands(find) {
    [this.where, this.hard] = [find(".where"), find(".hard")];
    this.where.oninput = () => this.strike(Number(this.where.value), this.j);
    this.hard.oninput = () => this.strike(this.i, Number(this.hard.value));
  }

  /** Move on the map by keys. */
  key(event) {
    const { key, target } = event, step = STEPS[key];
    if (!step || target !== this.map || event.ctrlKey || event.altKey || event.metaKey)
      return super.key(event);
    event.preventDefault();
    this.move(...step);
  }

  move(places, strengths) {
    const { d, F } = this.film.table, within = (i, { length }) =>
      Math.min(length - 1, Math.max(0, i));
    this.strike(within(this.i + places, d), within(this.j + strengths, F));
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
    const { d, F } = this.film.table;
    this.strike(this.placeOf(px - x, d), this.placeOf(this.strength(pz - z), F));
  }

  pointed({ offsetX, offsetY }) {
    const { d, F } = this.film.table, { left, top, across, up } = cellsOf(this.map);
    this.strike(this.cellAt((offsetX - left) / across, d.length),
      this.cellAt(1 - (offsetY - top) / up, F.length));
  }

  /** The place in a table of the value nearest to one. */
  placeOf(value, values) {
    return values.reduce((best, each, i) =>
      (Math.abs(each - value) < Math.abs(values[best] - value) ? i : best), 0);
  }

  /** The cell at a part of the map's width or height. */
  cellAt(part, count) {
    return Math.min(count - 1, Math.max(0, Math.floor(part * count)));
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
    this.told = { headline: table.headlines[n], reasons: table.reasons[n],
      name: table.names[table.outcomes[n]] };
    const { weight } = this.strip, states = this.strip.motion.states(PARTS);
    this.curves = ["N", "F"].map((name) => curveOf(states.map((at) => [at.t, at[name] / weight])));
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

  /** Write what happens, and speak it when another reason holds. */
  tell() {
    const { headline, reasons } = this.told;
    const told = (sentences) => sentences.map((each) => this.say(...each)).join(" ");
    const events = this.strip.events.map(([t, kind]) =>
      this.say("event", { event: this.say(kind), t }));
    if (events.length > 8) events.splice(8, events.length, this.say("more", {
      count: events.length - 8 }));
    const lines = [told(headline), told(reasons), events.join(", ")];
    const said = this.box.querySelectorAll(".said p");
    lines.forEach((text, k) => { said[k].textContent = text; });
    const spoken = this.box.querySelector(".spoken");
    const kind = [...headline, ...reasons].map(([key]) => key).join();
    if (spoken.dataset.kind !== kind) spoken.textContent = `${lines[0]} ${lines[1]}`;
    spoken.dataset.kind = kind;
    const [N, shear] = this.curves, peak = Math.max(N.most, shear.most, -shear.least);
    this.plot.setAttribute("aria-label", this.say("forces_spoken", { t: this.strip.motion.end,
      N_least: N.least, N_most: N.most, F_least: shear.least, F_most: shear.most }));
    const { cut } = this.film;
    const isCut = Math.max(N.most, shear.most) > cut[1] || shear.least < cut[0];
    this.plot.nextElementSibling.textContent = this.say("forces")
      + (isCut ? this.say("forces_cut", { peak }) : "");
  }

  /** Write what the blow does, and speak where it is. */
  describe() {
    const { d, F } = this.blow();
    this.tell();
    [this.where.value, this.hard.value] = [this.i, this.j];
    this.where.nextElementSibling.value = this.say("place", { d });
    this.hard.nextElementSibling.value = this.say("strength", { F });
    const [place, strength] = [this.say("place_spoken", { d }), this.say("strength_spoken", { F })];
    this.where.setAttribute("aria-valuetext", place);
    this.hard.setAttribute("aria-valuetext", strength);
    this.map.setAttribute("aria-valuenow", this.n + 1);
    this.map.setAttribute("aria-valuetext", `${place}, ${strength}: ${this.say(this.told.name)}`);
    this.host.dataset.blow = `${d} ${F}`;
  }

  code() {
    const { d, F } = this.blow();
    return this.film.table.code.replace("{F}", F).replace("{d}", d);
  }

  async copy(button, lines) {
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

  paintMap(ink) {
    const { table } = this.film, { d, F } = table, area = cellsOf(this.map);
    const [wide, tall] = [area.across / d.length, area.up / F.length];
    const corner = (i, j) => [area.left + i * wide, area.top + area.up - (j + 1) * tall];
    table.outcomes.forEach((code, n) => {
      ink.fillStyle = table.colours[code];
      ink.fillRect(...corner(Math.floor(n / F.length), n % F.length), wide + 0.7, tall + 0.7);
    });
    paintCursor(ink, this.colours, ...corner(this.i, this.j), wide, tall);
    const along = (values, places) => places.map((i) => [(i + 0.5) / values.length, values[i]]);
    paintSides(ink, this.colours, area, along(d, [0, (d.length - 1) / 2, d.length - 1]),
      along(F, [0, F.length - 1]), [this.say("map_places"), this.say("map_strengths")]);
  }

  paintPlot(ink) {
    const { curves, film: { cut, least }, strip: { events } } = this;
    const [N, F] = curves;
    paintCurves(ink, this.colours, this.plot, [{ ...N, name: "N", colour: "blue", dash: [] },
      { ...F, name: "F", colour: "orange", dash: [5, 3] }], {
      high: Math.min(cut[1], Math.max(least[1], N.most, F.most)),
      low: Math.max(cut[0], Math.min(least[0], N.least, F.least)),
      end: this.film.end, now: this.t,
      impacts: events.filter(([, kind]) => kind === "impact").map(([time]) => time),
    });
  }
}
