// The page with sliders and fields for the scene, the blow and the end time. Each frame shows the
// motion for the current numbers. Needs all modules of the player.

const FULL = 6; // number of half turns at which colours reach full strength
const SETTLED = 300; // time without changes after which the address is updated [ms]
const NO_BLOW = { jx: 0, jz: 0, dx: 0, dz: 0 };
const NOT_NAMED = [...Object.keys(NO_BLOW), "blows", "t"]; // not arguments of Scene

export class Workbench extends Explorer {
  constructor(host, film) {
    const { page } = film, linked = film.linked ?? inAddress(location.hash, page.usual);
    const language = linked.lang in page.languages ? linked.lang : film.words.lang;
    const own = { ...page.given, friction: page.given.friction ?? Infinity };
    super(host, { ...film, ...page.languages[language], own, linked, axes: ["dx", "jz"],
      given: own });
    addEventListener("hashchange", () => {
      const next = inAddress(location.hash, page.usual), { lang } = next;
      if (!host.isConnected || this.address === location.hash) return;
      this.open(next);
      this.change({});
      if (lang !== this.film.words.lang) this.speak(lang);
    });
  }

  begin() {
    const { words, own, linked } = this.film;
    document.documentElement.lang = words.lang;
    document.title = document.querySelector("h1").textContent = words.live_title;
    super.begin();
    this.open(linked);
    this.renew();
    const why = this.refusal;
    if (!why) return;
    this.open(own); // the scene in the address is impossible
    this.renew();
    this.refusal = why;
  }

  /** Set the numbers and the blows during the motion to those of an address. */
  open({ blows = "", ...numbers }) {
    Object.assign(this, { earlier: [], since: 0 });
    Object.assign(this.given, known(numbers, this.film.own));
    const texts = blows ? blows.split(",") : [];
    while (texts.length) { // a missing number is NaN, which the core refuses
      const [since, ...impulse] = Array.from({ length: 5 }, () => Number(texts.shift()));
      Object.assign(this, { earlier: this.blows(), since });
      Object.assign(this.given, this.givenOf(impulse));
    }
  }

  hands(find) {
    this.rows = this.film.page.inputs.map((input) => this.row(input));
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
    find(".reset").onclick = () => { this.open(this.film.own); this.change({}); };
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

  /** Set new numbers; their motion is computed in the next frame. A change of numbers other than
   * those of the blow also goes back to the start, and keeps the blows. */
  change(numbers) {
    super.change(known(numbers, this.film.own));
    if (!Object.keys(numbers).some((name) => name in NO_BLOW)) this.seek(0);
    clearTimeout(this.settling);
    this.settling = setTimeout(() => this.settle(), SETTLED);
  }

  /** Write the scene into the page's address, with the names of Scene's arguments. */
  settle() {
    const { blows, ...scene } = this.sceneOf(this.given);
    const numbers = Object.entries(scene).filter(([, value]) => value !== null);
    this.address = `#${new URLSearchParams({ ...Object.fromEntries(numbers),
      lang: this.film.words.lang })}${blows.length ? `&blows=${blows}` : ""}`;
    history.replaceState(null, "", this.address);
  }

  /** Rebuild the page in another language, in a new host element. */
  speak(language) {
    if (!(language in this.film.page.languages)) return;
    this.pause();
    clearTimeout(this.settling);
    const host = this.host.cloneNode();
    this.host.replaceWith(host);
    const [[, ...first], ...blows] = this.blows();
    const linked = { ...this.given, ...this.givenOf(first), blows: `${blows}`, lang: language };
    const next = new Workbench(host, { ...this.film, linked });
    next.settle();
    next.box.querySelector("button[lang]:not([hidden])").focus();
  }

  /** Compute the motion. If there is none, the last motion stays and `refusal` says why. */
  renew() {
    const { given, strip, film } = this, { a, b, slope, mass, gravity, x, t } = given;
    const before = { ...strip };
    film.end = t;
    Object.assign(strip, { a, b, slope, weight: mass * gravity, start: x });
    try {
      super.renew();
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

  /** The scene for the core: z and z_dot are null for a body on the ground, and x_dot, too, if it
   * rolls. */
  sceneOf({ k, height, slip, ...given }) {
    const { a, b, mass, theta, omega } = given, [h] = support(theta, a, b);
    const [[, jx, jz, dx, dz], ...blows] = this.blows(given);
    const flies = height > 0, x_dot = flies ? slip : slip ? h * omega + slip : null;
    return { ...given, inertia: k === 1 ? null : (k * mass * (a * a + b * b)) / 4, x_dot,
      z: flies ? h + height : null, z_dot: flies ? given.z_dot : null,
      jx: jx || jz ? jx : null, jz: jx || jz ? jz : null, dx, dz, blows };
  }

  impulseOf({ jx, jz, dx, dz }) {
    return [jx, jz, dx, dz];
  }

  givenOf([jx, jz, dx, dz]) {
    return { jx, jz, dx, dz };
  }

  code() {
    const { a, b, ...others } = this.sceneOf(this.given), { usual } = this.film.page;
    const numbers = Object.entries(others).filter(([name, value]) => !NOT_NAMED.includes(name)
      && value !== null && value !== Infinity && value !== usual[name])
      .map(([name, value]) => `, ${name}=${value}`).join("");
    const blow = others.jx === null ? "" : "blow = {blow}\n";
    const scene = `rl.Scene(${a}, ${b}${numbers}${blow && ", impulse=blow"})`;
    return super.code(`import rolling_ellipse as rl\n\n${blow}scene = ${scene}\n`
      + `motion = rl.simulate(scene, ${this.given.t}{blows})\n`);
  }

  /** Strike now. A point outside the body is moved into it, and a blow without strength gets half
   * of the largest strength. */
  strike() {
    if (!super.strike()) return false;
    const { jx, jz, dx, dz } = this.given, part = Math.min(1, 0.99 / this.sizeOf([dx, dz]));
    if (part < 1) Object.assign(this.given, { dx: rounded(part * dx), dz: rounded(part * dz) });
    if (!jx && !jz) this.given.jz = -rounded(this.film.strongest / 2);
    return true;
  }

  codeOf([jx, jz, dx, dz]) {
    return `rl.Impulse(jx=${jx}, jz=${jz}, dx=${dx}, dz=${dz})`;
  }

  // ------------------------------------------------------------------------------ the blow

  hand(view) {
    const { x, z } = this.strip.motion.at(this.now), { jx, jz, dx, dz } = this.given;
    const F = Math.hypot(jx, jz), far = this.length(F), [u, w] = F ? [jx / F, jz / F] : [0, -1];
    return { F, top: view.at(x + dx - far * u, z + dz - far * w), point: view.at(x + dx, z + dz) };
  }

  holds(event) {
    const { top, point: foot } = this.hand(this.views[0]), at = [event.offsetX, event.offsetY];
    const away = (place) => Math.hypot(place[0] - at[0], place[1] - at[1]);
    const held = super.holds(event), byFoot = away(foot) < Math.min(18, away(top));
    this.onBody ||= byFoot;
    return held || (byFoot && this.canStrike);
  }

  dragged(event) {
    const [px, pz] = this.placeOf(event), { dx, dz } = this.given;
    if (this.onBody) return this.change({ dx: rounded(px), dz: rounded(pz) });
    const [u, w] = [dx - px, dz - pz], far = Math.hypot(u, w) || 1;
    const strength = this.strength(far) / far;
    this.change({ jx: rounded(strength * u), jz: rounded(strength * w) });
  }

  // ------------------------------------------------------------------------------- the map

  get isMapless() {
    return false; // half turns can be counted with rolling resistance, too
  }

  axis(k) {
    return this.rows.find(({ name }) => name === this.axes[k]);
  }

  labelOf(k) {
    const { name, unit } = this.axis(k);
    return `${this.say(`in_${name}`)}${unit ? ` [${unit}]` : ""}`;
  }

  /** The colour and opacity of a cell, from the number of half turns up to the end; motions that
   * end early have a colour of their own, as do scenes without a motion. */
  colourOf(given) {
    const { film: { core }, colours } = this;
    try {
      const { ending } = core.ask(this.sceneOf(given), given.t, false);
      if (ending !== "COMPLETED") return [colours.plum, 1];
      const n = halfTurns(core.samples([given.t]).theta[0], given.theta);
      if (!n) return [colours.faint, 0.5];
      return [n > 0 ? colours.orange : colours.blue,
        0.2 + (0.8 * Math.min(FULL, Math.abs(n))) / FULL];
    } catch {
      return [colours.paper, 1];
    }
  }

  // ------------------------------------------------------------------------------- pictures

  fit(width) {
    this.lowest = width < 600 ? 0.6 : 0.33;
    Object.assign(this.strip, windowOf(this.strip, this.film.page.size, this.lowest, width));
    super.fit(width);
  }

  paintHand(ink, colours, hand) {
    super.paintHand(ink, colours, hand);
    disc(ink, colours.paper, colours.plum, hand.point, 4);
  }

  paintPlot(ink) {
    super.paintPlot(ink);
    this.paintEnergy(sized(this.energy, this.energy.clientHeight));
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

/** Read a number with decimal comma or point: a plain number, a multiple of pi, infinity, or an
 * angle in degrees. Other texts are NaN. */
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

const rounded = (value) => Number(value.toPrecision(4));
const halfTurns = (theta, start) => Math.round((theta - start) / Math.PI) + 0;

/** The page's numbers from an address. Addresses use the names of Scene's arguments; older ones use
 * those of the page. */
function inAddress(hash, usual) {
  const linked = Object.fromEntries(new URLSearchParams(hash.slice(1)));
  if (!linked.a || !linked.b || "k" in linked) return linked;
  const { inertia, z, x_dot, ...others } = { ...NO_BLOW, friction: Infinity, z_dot: null, ...usual,
    ...linked };
  const [a, b, mass, theta, omega] = ["a", "b", "mass", "theta", "omega"].map((name) =>
    Number(others[name]));
  const [h] = support(theta, a, b), flies = z > h * (1 + 8 * Number.EPSILON); // as Scene decides
  return { ...others, height: flies ? z - h : 0,
    k: inertia === undefined ? 1 : (4 * inertia) / (mass * (a * a + b * b)),
    slip: x_dot === undefined ? 0 : x_dot - (flies ? 0 : h * omega) };
}

/** The given numbers that the page has. Texts are read as numbers; the core refuses NaN. */
function known(numbers, own) {
  return Object.fromEntries(Object.entries(numbers).filter(([name]) => name in own)
    .map(([name, value]) => [name, value === null ? null : numberIn(`${value}`)]));
}

/** The window of a strip. Its width is the same for long semi-axes between size/2 and size, unless
 * a start high above the ground needs more. */
function windowOf({ a, b, slope, motion }, size, shape, width) {
  const { x, z } = motion.at(0), long = Math.max(a, b), sine = Math.abs(Math.sin(slope));
  const wide = Math.max((width < 600 ? 9 : 14) * Math.max(long, Math.min(size, 2 * long)),
    (z + 2.75 * long) / (shape - 0.06));
  const [left, foot] = [x * Math.cos(slope) - wide / 2, -x * Math.sin(slope)];
  const low = foot - 0.06 * wide, edge = Math.min(0.35 * wide, sine ? long / sine : Infinity);
  return { window: [left, left + wide, low, low + shape * wide], edge };
}
