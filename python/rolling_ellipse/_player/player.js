// The player: motions on one clock, drawn on a canvas from samples and their rates.
// Needs track.js and strip.js.

const NUDGES = { ArrowLeft: -1, ArrowRight: 1, ArrowDown: -10, ArrowUp: 10 };
const RATES = [0.1, 0.25, 0.5, 1, 2, 4];
const ICONS = { play: "M5 3l9 6-9 6z", pause: "M5 3h3v12H5zM11 3h3v12h-3z" };
/** Whether the theme of the page or, if it has none, the user's system requests dark colours. */
export function isDark(host) {
  const dark = ".dark, .vscode-dark, [data-theme=dark], [data-jp-theme-light=false]";
  const light = ".light, .vscode-light, [data-theme=light], [data-jp-theme-light=true]";
  const [night, day] = [host.closest(dark), host.closest(light)];
  if (night && day) return day.contains(night);
  return night ? true : day ? false : matchMedia("(prefers-color-scheme: dark)").matches;
}

/** Fit a canvas to a height [CSS px] and to the screen's resolution; return its cleared context. */
export function sized(canvas, height) {
  const dots = window.devicePixelRatio || 1, { clientWidth: width } = canvas;
  const across = Math.round(width * dots), down = Math.round(height * dots);
  if (canvas.width !== across || canvas.height !== down)
    Object.assign(canvas, { width: across, height: down });
  const ink = canvas.getContext("2d");
  ink.setTransform(across / width, 0, 0, down / height, 0, 0);
  ink.clearRect(0, 0, width, height);
  return ink;
}

export class Player {
  constructor(host, film) {
    const { parts = [[0, film.end]], forces = false } = film; // an explorer has no parts
    Object.assign(this, { host, film, parts, forces, t: 0, rate: 1, playing: false, fine: 6 });
    this.long = parts.reduce((sum, [begin, end]) => sum + end - begin, 0);
    host.dataset.ready = "";
    host.player = this;
    host.addEventListener("keydown", (event) => event.stopPropagation());
    for (const strip of film.strips)
      if (strip.track) this.take(strip, unpacked(strip.track.columns), strip.track.starts);
    point.sign = film.words.decimal;
    this.begin?.();
    this.build(host.attachShadow({ mode: "open" }));
    const still = matchMedia("(prefers-reduced-motion: reduce)").matches;
    new ResizeObserver(() => this.draw()).observe(this.box);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    const themes = new MutationObserver(() => this.draw());
    for (const node of [host, document.body, document.documentElement])
      themes.observe(node, { attributes: true, attributeFilter: ["class", "data-theme",
        "data-jp-theme-light"] });
    new IntersectionObserver(([entry]) => { this.seen = entry.isIntersecting; this.run(); })
      .observe(this.box);
    if (!still && film.end > 0 && !film.waits) this.play();
    this.draw();
  }

  /** Make a strip show another motion. */
  take(strip, columns, starts = [0]) {
    strip.motion = new Track(columns, strip.a);
    strip.traces = starts.map((start, k) => strip.motion.states(this.fine, start, starts[k + 1]));
    [strip.trace] = strip.traces;
  }

  /** Seconds of motion that the film shows before a time; `timeAt` is the inverse. */
  shown(t) {
    return this.parts.reduce((sum, [begin, end]) =>
      sum + Math.max(0, Math.min(t, end) - begin), 0);
  }

  timeAt(seconds) {
    for (const [begin, end] of this.parts) {
      if (seconds <= end - begin) return begin + Math.max(0, seconds);
      seconds -= end - begin;
    }
    return this.parts.at(-1)[1];
  }

  build(shadow) {
    shadow.innerHTML = `<style>${this.film.style}</style><div class="player" tabindex="0"
      role="group">${this.film.markup}</div>`;
    const find = (words) => shadow.querySelector(words);
    this.box = find(".player");
    this.box.setAttribute("aria-label", this.say("film"));
    this.canvas = find("canvas");
    this.slider = find(".seek input");
    this.clock = find(".time");
    this.select = find("select");
    const { speed, fastest = Infinity } = this.film; // faster bodies seem to roll backwards
    for (const rate of new Set([...RATES, 1 / speed].sort((one, other) => one - other)))
      if (rate === 1 || rate * speed <= fastest)
        this.select.add(new Option(`× ${+(rate * speed).toPrecision(3)}`, rate, rate === 1,
          rate === 1));
    this.toggle = find(".play");
    this.toggle.onclick = () => (this.playing ? this.pause() : this.play());
    find(".back").onclick = () => this.step(-1);
    find(".forth").onclick = () => this.step(1);
    find(".forces").setAttribute("aria-pressed", this.forces);
    find(".forces").onclick = ({ currentTarget }) => {
      this.forces = !this.forces;
      currentTarget.setAttribute("aria-pressed", this.forces);
      this.draw();
    };
    this.slider.oninput = () => { this.pause(); this.seek(this.timeAt(this.slider.value * this.long)); };
    this.select.onchange = () => { this.rate = Number(this.select.value); };
    this.box.onkeydown = (event) => this.key(event);
    this.marks();
  }

  /** Mark every event on the slider; events at nearly the same point share a mark. */
  marks() {
    const seek = this.slider.parentNode;
    seek.querySelectorAll(".mark").forEach((mark) => mark.remove());
    const seen = new Set();
    for (const [t, kind] of this.film.strips.flatMap((strip) => strip.events)) {
      const part = this.shown(t) / this.long, place = Math.round(500 * part);
      if (this.parts.every(([begin, end]) => t < begin || t > end) || seen.has(place)) continue;
      seen.add(place);
      const mark = document.createElement("span");
      mark.className = "mark";
      mark.title = this.say("event", { event: this.say(kind), t: t.toPrecision(4) });
      mark.style.left = `calc(8px + (100% - 16px) * ${part})`;
      seek.append(mark);
    }
  }

  key(event) {
    const { key, target } = event;
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (target !== this.slider && target.matches("select, input")) return;
    if (key === " " && target.tagName === "BUTTON") return;
    if (key === " ") this.toggle.click();
    else if (key in NUDGES) this.step(NUDGES[key]);
    else if (key === "Home") this.stepTo(0);
    else if (key === "End") this.stepTo(this.film.end);
    else if (key === "+" || key === "=") this.faster(1);
    else if (key === "-") this.faster(-1);
    else return;
    event.preventDefault();
  }

  faster(by) {
    const last = this.select.options.length - 1;
    this.select.selectedIndex = Math.min(last, Math.max(0, this.select.selectedIndex + by));
    this.rate = Number(this.select.value);
  }

  step(frames) {
    const frame = this.film.speed / this.film.fps;
    this.stepTo(this.timeAt((Math.round(this.shown(this.t) / frame) + frames) * frame));
  }

  stepTo(t) {
    this.pause();
    this.seek(t);
  }

  seek(t) {
    this.t = this.timeAt(this.shown(t));
    this.draw();
  }

  play() {
    if (this.t >= this.film.end) this.t = 0;
    this.show(true);
    this.run();
  }

  pause() {
    this.show(false);
  }

  show(playing) {
    this.playing = playing;
    const name = playing ? "pause" : "play";
    this.toggle.querySelector("path").setAttribute("d", ICONS[name]);
    this.toggle.title = this.say(name);
    this.toggle.setAttribute("aria-label", this.toggle.title);
  }

  /** Draw frames while the film plays and is in view. At its end the film pauses for a second, then
   * starts again. */
  run() {
    if (this.running || !this.playing || this.seen === false) return;
    this.running = true;
    let before = performance.now(), rested = 0;
    const frame = (now) => {
      this.running = this.playing && this.seen !== false;
      if (!this.running) return;
      const passed = Math.max(0, now - before) / 1000;
      before = now;
      rested = this.t >= this.film.end ? rested + passed : 0;
      if (rested > 1) this.t = 0;
      this.seek(this.timeAt(this.shown(this.t) + passed * this.rate * this.film.speed));
      requestAnimationFrame(frame);
    };
    requestAnimationFrame(frame);
  }

  /** The current states, with the centres in pixels, for scripts in the page. */
  state() {
    const bodies = this.film.strips.map((strip, i) => {
      const at = strip.motion.at(this.now), { columns = 1 } = this.film;
      const [px, py] = this.views[i].at(at.x, at.z);
      return { ...at, px: px + (columns > 1 ? (i / columns) * this.canvas.clientWidth : 0), py };
    });
    return { t: this.now, playing: this.playing, bodies };
  }

  /** Request a picture; at most one is drawn per frame of the screen. */
  draw() {
    this.slider.value = this.long > 0 ? this.shown(this.t) / this.long : 0;
    const text = this.t.toFixed(Math.max(3, this.film.decimals));
    this.now = Number(text); // the bodies are drawn for the time shown on the clock
    this.clock.textContent = this.say("clock", { t: text });
    this.slider.setAttribute("aria-valuetext", this.clock.textContent);
    this.waiting ||= requestAnimationFrame(() => { this.waiting = 0; this.paint(); });
  }

  paint() {
    const { film, canvas, box } = this;
    const width = canvas.clientWidth, height = Math.round(width * film.shape);
    if (!width) return;
    canvas.style.height = `${height}px`;
    const ink = sized(canvas, height);
    this.colours = film.colours[isDark(this.host) ? "dark" : "light"];
    for (const name in this.colours) box.style.setProperty(`--${name}`, this.colours[name]);
    ink.fillStyle = this.colours.paper;
    ink.fillRect(0, 0, width, height);
    const t = this.now, part = this.parts.findLastIndex(([begin]) => begin <= t);
    const states = film.strips.map((strip) => strip.motion.at(t)), { columns = 1 } = film;
    const across = width / columns; // width of a strip; strips are stacked or side by side
    this.views = this.viewsOf(states, width);
    let floor = 0;
    film.strips.forEach((strip, i) => {
      const tall = strip.share * height;
      strip.trace = strip.traces[part];
      ink.save();
      ink.translate(columns > 1 ? i * across : 0, 0);
      ink.beginPath();
      ink.rect(0, floor, across, tall);
      ink.clip();
      paintStrip(ink, this.colours, strip, states[i], this.views[i], {
        floor, width: across, tall, forces: this.forces, lasting: t / film.speed,
        beside: columns > 1,
        caption: this.caption(strip, states[i]), clock: i === columns - 1 ? this.clockText() : "",
        say: (key) => this.say(key),
      });
      this.over?.(ink, i);
      ink.restore();
      if (columns === 1) floor += tall;
    });
    this.host.dataset.time = this.t;
    canvas.setAttribute("aria-label", this.label(states));
  }

  /** Describe the states in words, for users who cannot see the picture. */
  label(states) {
    const near = (value, unit) => Math.round((1000 * value) / unit) * (unit / 1000);
    return states.map(({ theta, x }, i) => this.say("stage", { theta: near(theta, 1),
      x: near(x, this.film.strips[i].a), t: this.clock.textContent,
      name: this.film.strips[i].label }).trim()).join("; ");
  }

  /** The text of a key in the page's language, with values in place of the names in braces. */
  say(key, values = {}) {
    return this.film.words[key].replace(/\{(\w+)\}/g, (_, name) => round(values[name]));
  }

  /** The views of all strips. A camera stands still, follows the middle of all bodies, follows its
   * own body, or moves only when its body would come too close to an edge. */
  viewsOf(states, width) {
    const { strips, follows, shape } = this.film;
    const feet = strips.map(({ slope }, i) =>
      [states[i].x * Math.cos(slope), states[i].x * Math.sin(slope)]);
    const places = feet.map(([x]) => x);
    const middle = (Math.min(...places) + Math.max(...places)) / 2;
    let floor = 0;
    return strips.map((strip, i) => {
      const [x, y] = feet[i], across = width / (this.film.columns ?? 1);
      let place = follows === "own" ? [x, -y] : follows === "middle" ? [middle, -y] : [0, 0];
      if (follows === "edge") { // the view follows a body farther than `edge` away
        const { start, edge, slope } = strip, way = states[i].x - start;
        const along = start + way - Math.min(edge, Math.max(-edge, way));
        place = [along * Math.cos(slope), -along * Math.sin(slope)];
      }
      const view = new View(strip, strip.window, place, floor, across);
      if (across === width) floor += strip.share * shape * width;
      return view;
    });
  }

  /** The label of a motion and remarks on its current state; on separate lines if strips are side
   * by side. */
  caption(strip, at) {
    const parts = [], [perMetre, unit] = strip.unit ?? [1, "m"];
    if (this.film.follows === "own") {
      const size = perMetre * Math.max(strip.a, strip.b);
      const digits = Math.max(0, 1 - Math.floor(Math.log10(size)));
      parts.push(`x = ${(perMetre * at.x).toFixed(digits).replace("-", "−")} ${unit}`);
    }
    if (this.parts.length > 1) {
      const [turn, turns] = [at.theta - strip.theta, strip.turns].map((angle, i) =>
        Math.max(1, Math.ceil(Math.abs(angle) / (i ? 1 : 2 * Math.PI) - 1e-6)));
      parts.push(this.say("turn", { turn: `${turn}`, turns: `${turns}` }));
    }
    if (at.mode === SLIDING) parts.push(this.say("slides"));
    if (at.mode === FLIGHT) parts.push(this.say("flies"));
    if (strip.valid !== null && this.t >= strip.valid) parts.push(this.say("invalid"));
    const frame = this.film.speed / this.film.fps;
    const ended = strip.motion.end + frame < this.film.end && this.t > strip.motion.end;
    if (ended) parts.push(this.say("ended", { t: strip.motion.end }));
    const remarks = parts.join("   "), gap = this.film.columns > 1 ? "\n" : "   ";
    return [strip.label, remarks].filter(Boolean).join(gap);
  }

  clockText() {
    const speed = this.film.speed * this.rate;
    const text = `t = ${this.clock.textContent}`;
    return speed === 1 ? text : this.say("fast", { text, speed: `${+speed.toPrecision(3)}` });
  }
}
