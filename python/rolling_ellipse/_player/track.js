// A motion: samples with their rates, and cubics between them. Lengths are in metres and times in
// seconds; x is measured along the ground and z normal to it.

const KINDS = { u2: Uint16Array, f4: Float32Array, f8: Float64Array };

const bytesOf = (text) => Uint8Array.from(atob(text), (letter) => letter.charCodeAt(0));

/** Decode and unzip base64 text, such as the data of a page; returns the content as a Response. */
export function unzipped(text) {
  const unzip = new DecompressionStream("gzip");
  return new Response(new Blob([bytesOf(text)]).stream().pipeThrough(unzip));
}

export function unpacked(columns) {
  return Object.fromEntries(Object.entries(columns).map(([name, { kind, low, step, data }]) =>
    [name, Float64Array.from(new KINDS[kind](bytesOf(data).buffer), (n) => low + step * n)]));
}

/** Index of the last of `count` increasing times that is at most t, or 0; `time(k)` is time k. */
export function lastUntil(t, count, time) {
  let first = 0, end = count;
  while (end - first > 1) {
    const middle = (first + end) >> 1;
    if (time(middle) <= t) first = middle;
    else end = middle;
  }
  return first;
}

/** One motion, which gives its state at any time. Positions are cubics through two samples and
 * their rates; forces are parabolas through two samples and the value midway between them. */
export class Track {
  constructor(columns, a) {
    Object.assign(this, columns, { a });
    this.end = this.t.at(-1);
  }

  at(t) {
    const i = lastUntil(t, this.t.length, (k) => this.t[k]), last = i === this.t.length - 1;
    return this.between(i, last ? 0 : Math.max(0, t - this.t[i]) / (this.t[i + 1] - this.t[i]));
  }

  /** The state at a fraction u, from 0 to 1, of the way from sample i to the next one. */
  between(i, u) {
    const v = 1 - u, j = Math.min(i + 1, this.t.length - 1), span = this.t[j] - this.t[i];
    const line = (p) => v * p[i] + u * p[j];
    const parabola = (p, middle) => v * (v - u) * p[i] + 4 * u * v * middle[i] + u * (u - v) * p[j];
    const cubic = (p, rate) => v * v * (1 + 2 * u) * p[i] + u * u * (1 + 2 * v) * p[j]
      + u * v * span * (v * rate[i] - u * rate[j]);
    const x = cubic(this.x, this.x_dot), z = cubic(this.z, this.z_dot);
    const theta = cubic(this.theta, this.omega);
    return {
      t: line(this.t), x, z, theta, xDot: line(this.x_dot), omega: line(this.omega),
      N: parabola(this.normal_force, this.normal_force_middle),
      F: parabola(this.friction_force, this.friction_force_middle), mode: this.mode[i],
      tip: [x + this.a * Math.cos(theta), z - this.a * Math.sin(theta)],
    };
  }

  /** The states at samples first ... end - 1, and at `parts` - 1 times between two samples. */
  states(parts, first = 0, end = this.t.length) {
    const found = [];
    for (let i = first; i < end; i++)
      for (let part = 0; part <= (i + 1 < end ? parts : 0); part++)
        found.push(this.between(i, part / parts));
    return found;
  }
}

/** Height of the centre above the ground, and distance by which the contact is ahead of it. */
export function support(theta, a, b) {
  const sine = Math.sin(theta), cosine = Math.cos(theta);
  const height = Math.hypot(a * sine, b * cosine);
  return [height, ((a * a - b * b) * sine * cosine) / height];
}
