// The player with a hand that strikes the body, at rest or in motion, and a map of the outcomes of
// all blows. The core computes motions and outcomes in the page. Needs all other modules.

const STROBES = 8;
const [LOW, HIGH] = [[-0.5, -3], [1.5, 5]]; // usual and farthest limits of the force axis [weights]
const STEPS = { // columns and rows by which each key moves on the map
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowDown: [0, -1], ArrowUp: [0, 1],
  Home: [-99, 0], End: [99, 0], PageDown: [0, -4], PageUp: [0, 4],
};
const CELLS = [48, 32]; // columns and rows of the map
const COARSE = [8, 4, 2, 1]; // sizes of the map's cells, from the first pass to the last
const NEAR = 26; // distance within which a pointer grabs the hand [px]
const BUDGETS = [10, 6]; // time per frame for the map [ms]: usually, and while numbers change

export class Explorer extends Player {
  /** Start with the core; if WebAssembly is missing or forbidden, only the film plays. */
  static async on(host, film) {
    host.dataset.ready = "";
    try {
      film.core = await Core.of(await unzipped(film.wasm).arrayBuffer());
    } catch {
      return new Player(host, { ...film, waits: false }).box.classList.add("film-only");
    }
    return new this(host, film);
  }

  begin() {
    const { strips: [strip], given, axes, shape } = this.film, [width, height] = CELLS;
    Object.assign(this, { strip, axes, given: { ...given }, lowest: shape, fine: 2 });
    Object.assign(this, { earlier: [], since: 0 }); // blows before the last one; its time
    this.image = Object.assign(document.createElement("canvas"), { width, height });
    this.renew();
  }

  build(shadow) {
    super.build(shadow);
    const find = (words) => this.box.querySelector(words);
    [this.map, this.plot] = [find(".map canvas"), find(".plot canvas")];
    find(".strike").onclick = () => this.strike() || this.play();
    find(".undo").onclick = () => this.undo();
    find(".copy").onclick = ({ currentTarget }) => this.copy(currentTarget, this.code());
    this.grab(this.canvas, (event) => this.holds(event), (event) => this.dragged(event));
    const mouse = ({ pointerType }) => pointerType !== "touch"; // a finger only taps the map
    this.grab(this.map, mouse, (event) => this.pointed(event));
    new IntersectionObserver(([{ isIntersecting }]) => {
      this.fills = isIntersecting;
      if (this.fills) this.draw();
    }).observe(this.map.parentNode);
    if (this.isMapless) {
      this.map.style.display = "none";
      find(".map figcaption").textContent = this.say("no_map");
    }
    this.hands(find);
    this.describe();
  }

  /** Whether the body has no outcomes to map, since rolling resistance brings it to rest. */
  get isMapless() {
    return this.film.scene.rolling_resistance > 0;
  }

  /** Connect each slider of the page with an axis of the map. */
  hands(find) {
    this.sliders = [find(".where"), find(".hard")];
    this.sliders.forEach((slider, k) => {
      slider.oninput = () => this.changeParts({ [k]: slider.value / slider.max });
    });
  }

  /** Move on the map with the arrow keys, or undo the last blow with Escape. */
  key(event) {
    const { key, target } = event, steps = STEPS[key];
    if (key === "Escape" && !target.matches("select, [inputmode]")) this.undo();
    if (!steps || target !== this.map || event.ctrlKey || event.altKey || event.metaKey)
      return super.key(event);
    event.preventDefault();
    const moved = [0, 1].filter((k) => steps[k]);
    this.changeParts(Object.fromEntries(moved.map((k) => [k, this.part(k) + steps[k] / CELLS[k]])));
  }

  /** Call `moved` when a pointer is pressed where `holds` accepts it, while it is held down, and
   * for taps on the map. */
  grab(canvas, holds, moved) {
    let held = false, now = 0; // time of the motion when the pointer was pressed
    canvas.addEventListener("pointerdown", (event) => {
      held = holds(event);
      if (!held) return;
      canvas.setPointerCapture(event.pointerId);
      if (canvas === this.canvas) this.strike();
      moved(event);
      ({ now } = this);
    });
    canvas.addEventListener("touchstart", (event) => { // a dragging finger must not scroll
      if (held && event.cancelable) event.preventDefault();
    }, { passive: false });
    canvas.addEventListener("pointermove", (event) => {
      if (held && this.now === now) moved(event);
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

  // ---------------------------------------------------------------------------- the numbers

  /** Set new numbers; their motion is computed in the next frame. */
  change(numbers) {
    Object.assign(this.given, numbers);
    this.pause();
    this.t = this.since;
    this.stale = true;
    this.draw();
  }

  /** An axis of the map: the name of its number, its range and its step. The range of d is the
   * width of the body at the time of the blow. */
  axis(k) {
    if (k > 0) return this.axes[k];
    const { strip: { a, b }, axes: [{ name, most, step }], film: { core } } = this;
    const [theta] = core.samples([this.since]).theta, [reach] = support(theta + Math.PI / 2, a, b);
    return { name, least: -reach, most: reach, step: (step * reach) / most };
  }

  /** The position of the current number along an axis, as a fraction. */
  part(k) {
    const { name, least, most } = this.axis(k);
    return Math.min(1, Math.max(0, (this.given[name] - least) / (most - least)));
  }

  /** Set numbers to the values at given fractions of their axes. */
  changeParts(parts) {
    this.change(Object.fromEntries(Object.entries(parts).map(([k, part]) => {
      const { name, least, most, step } = this.axis(k), count = (part * (most - least)) / step;
      return [name, within(this.axis(k), least + Math.round(count) * step)];
    })));
  }

  /** The scene for the core, with the given numbers and all blows; absent numbers are null. */
  sceneOf(given) {
    const { scene } = this.film, [[, jx, jz, dx, dz], ...blows] = this.blows(given);
    return { ...scene, friction: scene.friction ?? Infinity, jx, jz, dx, dz, blows };
  }

  /** Compute the motion for the current numbers; a RangeError states why there is none. */
  renew() {
    const { strip, film: { end, core } } = this;
    const { found, times, columns, track } = core.motion(this.sceneOf(this.given), end);
    const { normal_force: N, friction_force: F } = columns, { weight } = strip;
    const curve = (values) => curveOf(Array.from(times, (t, i) => [t, values[i] / weight]));
    Object.assign(this, { found, times, columns, curves: [curve(N), curve(F)] });
    strip.events = found.events;
    this.take(strip, track);
  }

  // ------------------------------------------------------------------------------ the blows

  /** All blows in order: rows of t, jx, jz, dx and dz. The last one has the given numbers. */
  blows(given = this.given) {
    return [...this.earlier, [this.since, ...this.impulseOf(given)]];
  }

  /** The impulse for given numbers, as jx, jz, dx and dz; `givenOf` is the inverse. */
  impulseOf({ d, F }) {
    return [0, -F, d, 0];
  }

  givenOf([, jz, dx]) {
    const { least, most } = this.axis(0);
    return { d: Math.min(most, Math.max(least, dx)), F: -jz };
  }

  /** Set the earlier blows and the last one, and show the body at the time of the last one. */
  follow(earlier, [since, ...impulse]) {
    Object.assign(this, { earlier, since });
    this.change(this.givenOf(impulse));
  }

  /** Whether the hand can strike at the time shown on the clock. */
  get canStrike() {
    return this.now === this.since || this.now < this.strip.motion.end;
  }

  /** Strike now: add a blow like the last one at the time shown on the clock, and remove later
   * blows. Returns false if the hand cannot strike, or if the last blow is already at this time. */
  strike() {
    const { now, playing } = this, blows = this.blows();
    if (now === this.since || !this.canStrike) return false;
    this.follow(blows.filter(([t]) => t < now), [now, ...blows.at(-1).slice(1)]);
    if (playing) this.play();
    return true;
  }

  /** Remove the last blow, unless it is the only one. */
  undo() {
    const before = this.earlier.at(-1);
    if (before) this.follow(this.earlier.slice(0, -1), before);
  }

  // ------------------------------------------------------------------------------- the hand

  /** Distance of the hand from the struck point [m] for strength F; `strength` is the inverse. */
  length(F) {
    return (0.5 + (1.7 * F) / this.film.strongest) * Math.max(this.strip.a, this.strip.b);
  }

  strength(length) {
    const { strip: { a, b }, film: { strongest } } = this;
    return Math.max(0, length / Math.max(a, b) - 0.5) * (strongest / 1.7);
  }

  /** The strength of the blow, and the places of the hand and of the struck point in pixels. */
  hand(view) {
    const { x, z } = this.strip.motion.at(this.now), { d, F } = this.given;
    return { F, top: view.at(x + d, z + this.length(F)), point: view.at(x + d, z) };
  }

  /** Whether the hand can strike, and a pointer is near its arrow or on the body. */
  holds(event) {
    const { top: [u, v], point: [x, y] } = this.hand(this.views[0]);
    const [c, s, p, q] = [x - u, y - v, event.offsetX - u, event.offsetY - v];
    const part = Math.min(1, Math.max(0, (p * c + q * s) / (c * c + s * s)));
    this.onBody = Math.hypot(p, q) > NEAR && this.sizeOf(this.placeOf(event)) < 1;
    return this.canStrike && (this.onBody || Math.hypot(p - part * c, q - part * s) < NEAR);
  }

  /** Distance of a place from the centre, as a multiple of the radius in its direction. */
  sizeOf([u, w]) {
    const { a, b, motion } = this.strip, { theta } = motion.at(this.now);
    const [c, s] = [Math.cos(theta), Math.sin(theta)];
    return Math.hypot((c * u - s * w) / a, (s * u + c * w) / b);
  }

  /** The place of a pointer relative to the centre of the body [m]. */
  placeOf({ offsetX, offsetY }) {
    const at = this.strip.motion.at(this.now), [view] = this.viewsOf([at], this.canvas.clientWidth);
    const [px, pz] = view.ground(offsetX, offsetY);
    return [px - at.x, pz - at.z];
  }

  dragged(event) {
    const [u, w] = this.placeOf(event), d = within(this.axis(0), u);
    this.change(this.onBody ? { d } : { d, F: within(this.axis(1), this.strength(w)) });
  }

  pointed({ offsetX, offsetY }) {
    const { left, top, across, up } = cellsOf(this.map);
    this.changeParts([(offsetX - left) / across, 1 - (offsetY - top) / up]);
  }

  // ------------------------------------------------------------------------------ the words

  /** Write what happens, and announce it to screen readers if the sentences have changed. */
  tell() {
    const { headline, reasons } = this.found;
    const inWords = (sentences) => sentences.map((each) => this.say(...each)).join(" ");
    const events = this.strip.events.map(([t, kind]) =>
      this.say("event", { event: this.say(kind), t }));
    if (events.length > 8) events.splice(8, events.length, this.say("more", {
      count: events.length - 8 }));
    const lines = [inWords(headline), inWords(reasons), events.join(", ")];
    const said = this.box.querySelectorAll(".said p");
    lines.forEach((text, k) => { said[k].textContent = text; });
    this.box.querySelector(".undo").setAttribute("aria-disabled", !this.earlier.length);
    const spoken = this.box.querySelector(".spoken");
    const kind = [...headline, ...reasons].map(([key]) => key).join() + this.since;
    if (spoken.dataset.kind !== kind) spoken.textContent = `${lines[0]} ${lines[1]}`;
    spoken.dataset.kind = kind;
    const [N, shear] = this.curves, peak = Math.max(N.most, shear.most, -shear.least);
    this.plot.setAttribute("aria-label", this.say("forces_spoken", { t: this.strip.motion.end,
      N_least: N.least, N_most: N.most, F_least: shear.least, F_most: shear.most }));
    const isCut = Math.max(N.most, shear.most) > HIGH[1] || shear.least < LOW[1];
    this.plot.nextElementSibling.textContent = this.say("forces")
      + (isCut ? this.say("forces_cut", { peak }) : "");
  }

  /** Write what happens, and the blow's place and strength beside the sliders and on the map. */
  describe() {
    const { d, F } = this.given;
    this.tell();
    const spoken = [this.say("place_spoken", { d }), this.say("strength_spoken", { F })];
    [this.say("place", { d }), this.say("strength", { F })].forEach((text, k) => {
      const slider = this.sliders[k];
      slider.value = this.part(k) * slider.max;
      slider.setAttribute("aria-valuetext", spoken[k]);
      slider.nextElementSibling.value = text;
    });
    this.map.setAttribute("aria-valuenow", Math.round(100 * this.part(0)));
    this.map.setAttribute("aria-valuetext",
      `${spoken.join(", ")}: ${this.say(this.found.first)}`);
    this.host.dataset.blow = `${d} ${F}`;
  }

  /** The Python code, with the first blow instead of {blow} and an argument with the later ones
   * instead of {blows}. */
  code(lines = this.film.code) {
    const [[, first], ...later] = this.blows().map(([t, ...impulse]) => [t, this.codeOf(impulse)]);
    const pairs = later.map((pair) => `(${pair.join(", ")})`).join(", ");
    return lines.replace("{blow}", first).replace("{blows}", pairs && `, blows=[${pairs}]`);
  }

  codeOf([, jz, dx]) {
    return `rolling_ellipse.Impulse.press(${-jz}, ${dx})`;
  }

  async copy(button, lines) {
    this.host.dataset.code = lines;
    try {
      await navigator.clipboard.writeText(lines);
      button.textContent = this.say("copied");
    } catch { // without access to the clipboard, the page shows the code
      const shown = Object.assign(document.createElement("pre"), { textContent: lines });
      button.replaceWith(shown);
      getSelection().selectAllChildren(shown);
    }
  }

  // ------------------------------------------------------------------------------- the map

  /** Paint the map; while it is in view, compute more cells, up to a time and in later frames. */
  paintMap(until) {
    if (this.isMapless) return;
    const done = !this.fills || this.fill(until), ink = sized(this.map, this.map.clientHeight);
    const area = cellsOf(this.map), { left, top, across, up } = area;
    ink.imageSmoothingEnabled = false;
    ink.drawImage(this.image, left, top, across, up);
    const [x, y] = [this.part(0), this.part(1)];
    paintCursor(ink, this.colours, left + x * across - 5, top + (1 - y) * up - 5, 10, 10);
    const ends = ({ least, most }) => [[0, least], [0.5, (least + most) / 2], [1, most]];
    paintSides(ink, this.colours, area, ends(this.axis(0)), ends(this.axis(1)),
      [this.labelOf(0), this.labelOf(1)]);
    if (!done) this.filling ||= requestAnimationFrame(() => {
      this.filling = 0; // a requested picture will paint the map, too
      if (!this.waiting) this.paintMap(performance.now() + BUDGETS[0]);
    });
  }

  /** Colour cells of the map up to a time, coarse ones first; returns true if none are left. */
  fill(until) {
    const axes = [this.axis(0), this.axis(1)], others = { ...this.given };
    for (const { name } of axes) delete others[name];
    const key = JSON.stringify([axes.map(({ name }) => name), others, this.earlier, this.since,
      others.friction === Infinity, this.colours.paper]);
    if (key !== this.mapped) Object.assign(this, { mapped: key, cells: cellsInTurn() });
    const ink = this.image.getContext("2d");
    while (performance.now() < until) {
      const { value: cell, done } = this.cells.next();
      if (done) return true;
      const [i, j, size] = cell;
      const numbers = axes.map(({ name, least, most }, k) =>
        [name, least + ((k ? CELLS[1] - j - size / 2 : i + size / 2) / CELLS[k]) * (most - least)]);
      const [colour, alpha] = this.colourOf({ ...this.given, ...Object.fromEntries(numbers) });
      for (const [style, part] of [[this.colours.paper, 1], [colour, alpha]]) {
        Object.assign(ink, { fillStyle: style, globalAlpha: part });
        ink.fillRect(i, j, size, size);
      }
    }
    return false;
  }

  /** The colour and opacity of a cell, from its first outcome; shows that outcome in the legend. */
  colourOf(given) {
    const { core, end, outcomes } = this.film, first = core.first(this.sceneOf(given), end);
    this.box.querySelector(`[data-outcome=${first}]`).hidden = false;
    return [outcomes[first], 1];
  }

  labelOf(k) {
    return this.say(["map_places", "map_strengths"][k]);
  }

  // ------------------------------------------------------------------------------- pictures

  /** Draw over the body: the path of the motion, outlines of the body along it, and the hand. */
  over(ink) {
    const { strip, colours, views: [view] } = this, end = strip.motion.end;
    ink.globalAlpha = 0.4;
    line(ink, colours.orange, 1.2, strip.trace.map(({ x, z }) => view.at(x, z)));
    for (let k = 1; k <= STROBES; k++) {
      outline(ink, strip, strip.motion.at((k / STROBES) * end), view);
      ink.globalAlpha = 0.2 + (0.3 * k) / STROBES;
      stroke(ink, colours.blue, 1);
    }
    ink.globalAlpha = this.now === this.since ? 1 : 0.4; // a pale hand has not struck yet
    if (this.canStrike) this.paintHand(ink, colours, this.hand(view));
    ink.globalAlpha = 1;
  }

  paintHand(ink, colours, { top, point: foot, F }) {
    const words = this.now === this.since ? `${round(F)} N s` : "";
    arrow(ink, colours.plum, top, foot, 4);
    disc(ink, colours.plum, colours.paper, top, 11);
    Object.assign(ink, { strokeStyle: colours.paper, lineWidth: 4, lineJoin: "round",
      font: "13px system-ui, sans-serif", textAlign: "left" });
    ink.strokeText(words, top[0] + 17, top[1] + 4);
    text(ink, colours.plum, words, top[0] + 17, top[1] + 4, "left");
  }

  /** Set the shape of the picture for a width, with 34 pixels for the numbers below the ground. */
  fit(width) {
    const [left, right, , top] = this.strip.window;
    this.film.shape = Math.max(this.lowest, top / (right - left) + 34 / width);
  }

  paint() {
    const { clientWidth: width } = this.canvas, begun = performance.now();
    if (!width || !this.map) return;
    const budget = BUDGETS[this.stale ? 1 : 0];
    if (this.stale) {
      this.renew();
      this.describe();
      this.marks();
      this.stale = false;
    }
    this.fit(width);
    this.strip.blows = this.blows().filter(([t]) => t !== this.now); // the hand shows that one
    super.paint();
    this.paintPlot(sized(this.plot, this.plot.clientHeight));
    this.paintMap(Math.max(begun + budget, performance.now() + 1));
  }

  paintPlot(ink) {
    const { curves: [N, F], strip: { events } } = this;
    paintCurves(ink, this.colours, this.plot, [{ ...N, name: "N", colour: "blue", dash: [] },
      { ...F, name: "F", colour: "orange", dash: [5, 3] }], {
      high: Math.min(HIGH[1], Math.max(HIGH[0], N.most, F.most)),
      low: Math.max(LOW[1], Math.min(LOW[0], N.least, F.least)),
      end: this.film.end, now: this.t,
      impacts: events.filter(([, kind]) => kind === "impact" || kind === "blow").map(([t]) => t),
    });
  }
}

/** A number limited to the range of an axis and rounded to a hundredth of its step or less. */
function within({ least, most, step }, value) {
  const decimals = Math.max(0, 2 - Math.floor(Math.log10(step)));
  return Math.min(most, Math.max(least, Number(value.toFixed(decimals)))) + 0;
}

/** The cells of the map with their sizes, the largest first. */
function* cellsInTurn() {
  for (const size of COARSE)
    for (let j = 0; j < CELLS[1]; j += size)
      for (let i = 0; i < CELLS[0]; i += size) yield [i, j, size];
}
