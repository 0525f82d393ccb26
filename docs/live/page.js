// A page on which every number of the scene can be moved; each frame shows the motion of its own
// numbers. It needs all modules of the player before it.

const CELLS = [48, 32]; // columns and rows of the map
const COARSE = [8, 4, 2, 1]; // sizes of its cells, one after the other
const BUDGETS = [10, 6]; // time of a frame up to which cells of the map are begun, and while a
// slider moves [ms]
const FULL = 6; // half turns of the strongest colours
const SETTLED = 300; // time without a change after which the address has the scene [ms]
const NOT_NAMED = ["jx", "jz", "dx", "dz", "t"]; // among the arguments of Scene

export class Workbench extends Live {
  constructor(host, film) {
    const live = { ...film.live, ...film.page }, linked = live.linked ?? inAddress(location.hash);
    const language = linked.lang in live.languages ? linked.lang : film.words.lang;
    super(host, { ...film, ...live.languages[language], live: { ...live, linked } });
    addEventListener("hashchange", () => {
      const { lang, ...numbers } = inAddress(location.hash);
      if (!host.isConnected || this.address === location.hash) return;
      this.change(numbers);
      if (lang !== this.film.words.lang) this.speak(lang);
    });
  }

  begin() {
    const { strips: [strip], live, words } = this.film;
    Object.assign(this, { strip, fine: 2, axes: ["dx", "jz"] });
    this.own = { ...live.given, friction: live.given.friction ?? Infinity };
    this.given = { ...this.own, ...known(live.linked, this.own) };
    const long = () => Math.max(strip.a, strip.b);
    this.length = (J) => (0.5 + (1.7 * J) / live.strongest) * long();
    this.strength = (length) => Math.max(0, length / long() - 0.5) * (live.strongest / 1.7);
    const [width, height] = CELLS;
    this.image = Object.assign(document.createElement("canvas"), { width, height });
    document.documentElement.lang = words.lang;
    document.title = document.querySelector("h1").textContent = words.live_title;
    this.renew();
    if (!this.told) { // the address has a scene that cannot be
      this.given = { ...this.own };
      this.renew();
    }
  }

  hands(find) {
    this.rows = this.film.live.inputs.map((input) => this.row(input));
    for (const group of new Set(this.rows.map((each) => each.group))) {
      const set = document.createElement("fieldset"), legend = document.createElement("legend");
      legend.textContent = this.say(`live_${group}`);
      set.append(legend, ...this.rows.filter((each) => each.group === group).map(({ row }) => row));
      find(".inputs").append(set);
    }
    this.energy = find(".energy canvas");
    this.selects = [...this.box.querySelectorAll(".axes select")];
    this.selects.forEach((select, k) => {
      for (const { name } of this.rows.filter((row) => row.name !== "t"))
        select.add(new Option(this.say(`in_${name}`), name, false, name === this.axes[k]));
      select.onchange = () => { this.axes[k] = select.value; this.describe(); this.draw(); };
    });
    find(".reset").onclick = () => this.change(this.own);
    find(".link").onclick = ({ currentTarget }) => {
      this.settle();
      this.copy(currentTarget, location.href);
    };
    for (const button of this.box.querySelectorAll("button[lang]")) {
      button.hidden = button.lang === this.film.words.lang;
      button.onclick = () => this.speak(button.lang);
    }
  }

  /** A slider and a field for a number of the scene. */
  row({ name, unit, least, most, step, group }) {
    const row = document.createElement("div"), label = document.createElement("label");
    const [slider, field] = [0, 1].map(() => document.createElement("input"));
    row.className = "row";
    label.textContent = this.say(`in_${name}`);
    label.htmlFor = `in-${name}`;
    Object.assign(slider, { type: "range", id: `in-${name}`, min: least, max: most, step });
    slider.setAttribute("step", step);
    field.inputMode = "decimal";
    field.setAttribute("aria-label", `${label.textContent}${unit ? ` [${unit}]` : ""}`);
    const end = document.createElement("span");
    end.textContent = unit;
    slider.oninput = () => this.change({ [name]: name === "friction"
      && Number(slider.value) === most ? Infinity : Number(slider.value) });
    field.onchange = () => {
      const value = numberIn(field.value, unit);
      if (!Number.isNaN(value)) return this.change({ [name]: value });
      this.refusal = this.say("live_unread", { text: field.value });
      this.describe();
    };
    row.append(label, slider, field, end);
    return { name, unit, least, most, step, group, row, slider, field };
  }

  /** Take other numbers; they are computed in the next frame. */
  change(numbers) {
    Object.assign(this.given, known(numbers, this.own));
    this.pause();
    this.t = 0;
    this.stale = true;
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.settle(), SETTLED);
    this.draw();
  }

  /** Write the scene into the address of the page. */
  settle() {
    const numbers = Object.entries(this.given).filter(([, value]) => value !== null);
    this.address = `#${new URLSearchParams({ ...Object.fromEntries(numbers),
      lang: this.film.words.lang })}`;
    history.replaceState(null, "", this.address);
  }

  /** Go on in another language, in a new host. */
  speak(language) {
    const { live } = this.film;
    if (!(language in live.languages)) return;
    this.pause();
    clearTimeout(this.settling);
    const host = this.host.cloneNode();
    this.host.replaceWith(host);
    const linked = { ...this.given, lang: language };
    const next = new Workbench(host, { ...this.film, live: { ...live, linked } });
    next.settle();
    next.box.querySelector("button[lang]:not([hidden])").focus();
  }

  /** Compute the motion; without one, the last motion stays, and a sentence says why. */
  renew() {
    const { given, strip, film } = this, { a, b, slope, mass, gravity, x, t } = given;
    const before = { ...strip };
    film.end = t;
    Object.assign(strip, { a, b, slope, weight: mass * gravity, start: x });
    try {
      this.compute(sceneOf(given));
      Object.assign(this, { refusal: "", parts: [[0, t]], long: t });
      const { kinetic: T, potential: V, theta } = this.columns;
      this.energies = [T, V, T.map((kinetic, i) => kinetic + V[i])].map((values) =>
        curveOf(Array.from(this.times, (time, i) => [time, values[i]])));
      this.turned = halfTurns(theta.at(-1), given.theta);
    } catch (error) {
      if (!(error instanceof RangeError)) throw error;
      this.refusal = error.message;
      Object.assign(strip, before);
      [[, film.end]] = this.parts;
    }
  }

  describe() {
    const { given, turned } = this;
    this.tell();
    this.box.querySelector(".refused").textContent = this.refusal
      && this.say("live_refused", { why: this.refusal });
    for (const { name, unit, most, slider, field } of this.rows) {
      const value = given[name], text = round(value, 6);
      slider.value = Math.min(value, most);
      slider.setAttribute("aria-valuetext", `${text} ${unit}`.trim());
      if (this.box.getRootNode().activeElement !== field || !this.stale) field.value = text;
    }
    for (const [name, key] of [[".copy", "copy"], [".link", "live_link"]])
      this.box.querySelector(name)?.replaceChildren(this.say(key)); // no longer "copied"
    const names = this.axes.map((name) => `${this.say(`in_${name}`)} ${round(given[name], 6)}`);
    this.map.setAttribute("aria-valuenow", turned);
    this.map.setAttribute("aria-valuetext",
      `${names.join(", ")}: ${this.say("live_turned", { n: turned })}`);
    const [kinetic, potential, total] = this.energies;
    this.energy.setAttribute("aria-label", this.say("live_energies_spoken", {
      kinetic: kinetic.most, low: potential.least, high: potential.most, first: total.points[0][1],
      last: total.points.at(-1)[1] }));
  }

  code() {
    const { a, b, ...others } = sceneOf(this.given), usual = this.film.live.usual;
    const numbers = Object.entries(others).filter(([name, value]) => !NOT_NAMED.includes(name)
      && value !== null && value !== Infinity && value !== usual[name])
      .map(([name, value]) => `, ${name}=${value}`).join("");
    const { jx, jz, dx, dz } = others;
    const blow = jx === null ? "" : `blow = rl.Impulse(jx=${jx}, jz=${jz}, dx=${dx}, dz=${dz})\n`;
    return `import rolling_ellipse as rl\n\n${blow}scene = rl.Scene(${a}, ${b}${numbers}${
      blow && ", impulse=blow"})\nmotion = rl.simulate(scene, ${this.given.t})\n`;
  }

  // ------------------------------------------------------------------------------ the blow

  hand(view) {
    const { x, z } = this.strip.motion.at(0), { jx, jz, dx, dz } = this.given;
    const F = Math.hypot(jx, jz), far = this.length(F), [u, w] = F ? [jx / F, jz / F] : [0, -1];
    return { F, top: view.at(x + dx - far * u, z + dz - far * w), point: view.at(x + dx, z + dz) };
  }

  holds(event) {
    const { top, point: foot } = this.hand(this.views[0]), at = [event.offsetX, event.offsetY];
    const away = (place) => Math.hypot(place[0] - at[0], place[1] - at[1]);
    this.byFoot = away(foot) < Math.min(18, away(top));
    return this.byFoot || super.holds(event);
  }

  dragged({ offsetX, offsetY }) {
    const { x, z } = this.strip.motion.at(0), { dx, dz } = this.given, { clientWidth } = this.box;
    const [px, pz] = this.viewsOf([{ x }], clientWidth)[0].ground(offsetX, offsetY);
    if (this.byFoot) return this.change({ dx: rounded(px - x), dz: rounded(pz - z) });
    const [u, w] = [x + dx - px, z + dz - pz], far = Math.hypot(u, w) || 1;
    const strength = this.strength(far) / far;
    this.change({ jx: rounded(strength * u), jz: rounded(strength * w) });
  }

  // ------------------------------------------------------------------------------- the map

  axis(k) {
    return this.rows.find(({ name }) => name === this.axes[k]);
  }

  move(...steps) {
    this.change(Object.fromEntries(steps.flatMap((count, k) => {
      const { name, least, most, step } = this.axis(k);
      const wide = Math.max(1, Math.round((most - least) / step / CELLS[k]));
      const value = this.given[name] + count * wide * step;
      return count ? [[name, rounded(Math.min(most, Math.max(least, value)))]] : [];
    })));
  }

  pointed({ offsetX, offsetY }) {
    const { left, top, across, up } = cellsOf(this.map);
    const parts = [(offsetX - left) / across, 1 - (offsetY - top) / up];
    this.change(Object.fromEntries(parts.map((part, k) => {
      const { name, least, most, step } = this.axis(k);
      const value = least + Math.min(1, Math.max(0, part)) * (most - least);
      return [name, rounded(least + Math.round((value - least) / step) * step)];
    })));
  }

  /** Colour cells of the map, coarse ones first, until a time; begin anew for another map. */
  fill(until) {
    const axes = [this.axis(0), this.axis(1)], others = { ...this.given };
    for (const name of this.axes) delete others[name];
    const key = JSON.stringify([this.axes, others, others.friction === Infinity,
      this.colours.paper]);
    if (key !== this.mapped) Object.assign(this, { mapped: key, cells: cellsInTurn() });
    const ink = this.image.getContext("2d");
    while (performance.now() < until) {
      const { value: cell, done } = this.cells.next();
      if (done) return;
      const [i, j, size] = cell;
      const numbers = axes.map(({ name, least, most }, k) =>
        [name, least + ((k ? CELLS[1] - j - size / 2 : i + size / 2) / CELLS[k]) * (most - least)]);
      const [colour, alpha] = this.outcome({ ...this.given, ...Object.fromEntries(numbers) });
      ink.globalAlpha = 1;
      ink.fillStyle = this.colours.paper;
      ink.fillRect(i, j, size, size);
      ink.globalAlpha = alpha;
      ink.fillStyle = this.colours[colour];
      ink.fillRect(i, j, size, size);
    }
    this.draw();
  }

  /** Colour and strength for half turns until the end, or for a motion that jams, or none. */
  outcome(given) {
    try {
      const { ending, columns } = this.film.live.core.motion(sceneOf(given), given.t, [given.t]);
      if (ending !== COMPLETED) return ["plum", 1];
      const n = halfTurns(columns.theta[0], given.theta);
      return n ? [n > 0 ? "orange" : "blue", 0.2 + (0.8 * Math.min(FULL, Math.abs(n))) / FULL]
        : ["faint", 0.5];
    } catch {
      return ["paper", 1];
    }
  }

  // ------------------------------------------------------------------------------- pictures

  paint() {
    const { box } = this, { clientWidth: width } = box, begun = performance.now();
    if (!width) return;
    const budget = BUDGETS[this.stale ? 1 : 0];
    if (this.stale) {
      this.renew();
      this.describe();
      this.marks();
      this.stale = false;
    }
    this.lowest = width < 600 ? 0.6 : 0.33;
    Object.assign(this.strip, windowOf(this.strip, this.film.live.size, this.lowest, width));
    super.paint();
    this.paintEnergy(sized(this.energy, this.energy.clientHeight));
    this.fill(Math.max(begun + budget, performance.now() + 1));
  }

  over(ink) {
    super.over(ink);
    disc(ink, this.colours.paper, this.colours.plum, this.hand(this.views[0]).point, 4);
  }

  paintMap(ink) {
    const area = cellsOf(this.map), { left, top, across, up } = area;
    ink.imageSmoothingEnabled = false;
    ink.drawImage(this.image, left, top, across, up);
    const axes = [this.axis(0), this.axis(1)];
    const [x, y] = axes.map(({ name, least, most }) =>
      (Math.min(most, Math.max(least, this.given[name])) - least) / (most - least));
    paintCursor(ink, this.colours, left + x * across - 5, top + (1 - y) * up - 5, 10, 10);
    const ends = ({ least, most }) => [[0, least], [0.5, (least + most) / 2], [1, most]];
    paintSides(ink, this.colours, area, ends(axes[0]), ends(axes[1]), axes.map(({ name, unit }) =>
      `${this.say(`in_${name}`)}${unit ? ` [${unit}]` : ""}`));
  }

  paintEnergy(ink) {
    const [kinetic, potential, total] = this.energies;
    const low = Math.min(0, potential.least);
    const high = Math.max(1e-9, ...this.energies.map(({ most }) => most));
    paintCurves(ink, this.colours, this.energy, [
      { ...kinetic, name: "T", colour: "orange", dash: [] },
      { ...potential, name: "V", colour: "blue", dash: [2, 3] },
      { ...total, name: "E", colour: "ink", dash: [5, 3] },
    ], { low: low - 0.04 * (high - low), high: high + 0.04 * (high - low), end: this.film.end,
      now: this.t, impacts: [] });
  }
}

/** A number as people write it, with comma or point, by pi, infinite, or an angle in degrees. */
function numberIn(text, unit = "") {
  const plain = text.trim().replace(",", ".").replace("−", "-").replace("π", "pi");
  if (/^(∞|inf|infinity)$/i.test(plain)) return Infinity;
  const [, times, over = 1] = plain.match(/^([-+.\d]*) *\*? *pi *(?:\/ *([.\d]+))?$/i) ?? [];
  if (times !== undefined)
    return (Number(/\d/.test(times) ? times : `${times}1`) * Math.PI) / Number(over);
  const [, degrees] = plain.match(/^(.*\S) *(?:°|deg)$/i) ?? [];
  if (degrees !== undefined) return unit === "rad" ? (Number(degrees) * Math.PI) / 180 : NaN;
  return plain ? Number(plain) : NaN;
}

const inAddress = (hash) => Object.fromEntries(new URLSearchParams(hash.slice(1)));
const rounded = (value) => Number(value.toPrecision(4));
const halfTurns = (theta, start) => Math.round((theta - start) / Math.PI) + 0;

/** Those of some numbers, or their texts, that a page has. */
function known(numbers, own) {
  const pairs = Object.entries(numbers).filter(([name]) => name in own)
    .map(([name, value]) => [name, value === null ? null : numberIn(`${value}`)]);
  return Object.fromEntries(pairs.filter(([, value]) => !Number.isNaN(value)));
}

/** The scene for the core: absent numbers are null, as those of a body that touches and rolls. */
function sceneOf({ k, height, slip, ...given }) {
  const { a, b, mass, theta, omega, jx, jz } = given, [h] = support(theta, a, b);
  const flies = height > 0, x_dot = flies ? slip : slip ? h * omega + slip : null;
  return { ...given, inertia: k === 1 ? null : (k * mass * (a * a + b * b)) / 4, x_dot,
    z: flies ? h + height : null, z_dot: flies ? given.z_dot : null,
    jx: jx || jz ? jx : null };
}

/** The cells of the map with their sizes, all large ones first. */
function* cellsInTurn() {
  for (const size of COARSE)
    for (let j = 0; j < CELLS[1]; j += size)
      for (let i = 0; i < CELLS[0]; i += size) yield [i, j, size];
}

/** The window of a strip: it stays for bodies down to half a size, and a high start fits in. */
function windowOf({ a, b, slope, motion }, size, shape, width) {
  const { x, z } = motion.at(0), long = Math.max(a, b), sine = Math.abs(Math.sin(slope));
  const wide = Math.max((width < 600 ? 9 : 14) * Math.max(long, Math.min(size, 2 * long)),
    (z + 2.75 * long) / (shape - 0.06));
  const [left, foot] = [x * Math.cos(slope) - wide / 2, -x * Math.sin(slope)];
  const low = foot - 0.06 * wide, edge = Math.min(0.35 * wide, sine ? long / sine : Infinity);
  return { window: [left, left + wide, low, low + shape * wide], edge };
}
