// The explorer with the core itself: any blow, computed when it is given; the map keeps its table.
// It needs all modules before it.

const [FEWEST, MOST, TURN] = [300, 3000, 0.2]; // intervals of a motion, and turn in each [rad]

export class Live extends Explorer {
  /** Start with the core; where WebAssembly is missing or forbidden, the table of blows. */
  static async on(host, film) {
    host.dataset.ready = "";
    const { live } = film;
    try {
      live.core = await Core.of(await unzipped(live.wasm).arrayBuffer());
    } catch {
      const explorer = new Explorer(host, film), why = live.wasm ? "forbidden" : "missing";
      explorer.box.querySelector(".card p:last-child").append(` ${film.words[why]}`);
      return explorer;
    }
    return new this(host, film);
  }

  hands(find) {
    super.hands(find);
    for (const slider of [this.where, this.hard]) slider.step = 0.1;
    find(".nearest").textContent = this.say("exact");
  }

  /** The blow at a place between the columns and rows of the table. */
  blow() {
    const between = (values, i) => {
      const [low, part] = [Math.floor(i), i % 1];
      const value = part ? (1 - part) * values[low] + part * values[low + 1] : values[low];
      return part ? Number(value.toPrecision(5)) : value;
    };
    return { d: between(this.film.table.d, this.i), F: between(this.film.table.F, this.j) };
  }

  placeOf(value, values) {
    const low = Math.min(lastUntil(value, values.length, (i) => values[i]), values.length - 2);
    const part = (value - values[low]) / (values[low + 1] - values[low]);
    return Math.min(values.length - 1, Math.max(0, low + part));
  }

  cellAt(part, count) {
    return Math.min(count - 1, Math.max(0, part * count - 0.5));
  }

  choose(i, j) {
    Object.assign(this, { i, j, fine: 2 });
    this.n = Math.round(i) * this.film.table.F.length + Math.round(j);
    const { d, F } = this.blow(), { scene } = this.film.live;
    this.compute({ ...scene, friction: scene.friction ?? Infinity, jx: 0, jz: -F, dx: d, dz: 0 });
  }

  /** Take the motion of a scene; an error says why there is none. */
  compute(scene) {
    const { strip, film: { end, live: { core } } } = this;
    const found = core.motion(scene, end, [end], true), times = timesOf(found, scene.theta);
    const { columns } = core.motion(scene, end, times);
    const { normal_force: N, friction_force: F } = columns, { weight } = strip;
    const curve = (values) => curveOf(Array.from(times, (t, i) => [t, values[i] / weight]));
    Object.assign(this, { found, times, columns, told: told(found, scene),
      curves: [curve(N), curve(F)] });
    strip.events = found.events;
    this.take(strip, ofTrack(times, columns));
  }
}

/** Ends of intervals and their middles in turn; events, and the doubles before them, are ends. */
function timesOf({ until, events, columns: { theta: [last] } }, theta) {
  if (!until) return Float64Array.of(0);
  const count = Math.max(FEWEST, Math.min(MOST, Math.ceil(Math.abs(last - theta) / TURN)));
  const even = Array.from({ length: count + 1 }, (_, i) => (i / count) * until);
  const jumps = events.map(([t]) => t).filter((t) => t > 0 && t < until);
  const ends = Float64Array.of(...even, ...jumps, ...jumps.map((t) => t * (1 - Number.EPSILON)))
    .sort().filter((t, i, sorted) => t !== sorted[i - 1]);
  return Float64Array.from({ length: 2 * ends.length - 1 }, (_, i) =>
    (ends[Math.floor(i / 2)] + ends[Math.ceil(i / 2)]) / 2);
}

/** Columns for a track; between a jump and the double before it a force has their mean. */
function ofTrack(times, columns) {
  const isEnd = (_, i) => i % 2 === 0, found = { t: times.filter(isEnd) };
  for (const name in columns) found[name] = columns[name].filter(isEnd);
  for (const name of ["normal_force", "friction_force"]) {
    const values = columns[name], last = values.length - 1, end = times[last];
    found[`${name}_middle`] = found[name].map((value, n) => {
      const [middle, next] = [Math.min(2 * n + 1, last), Math.min(2 * n + 2, last)];
      const jumps = times[next] - times[2 * n] <= 1e-9 * end;
      return jumps ? (value + values[next]) / 2 : values[middle];
    });
  }
  return found;
}
