// States of a flight at any time.
// World axes are x, y, z with z up; lengths in m, times in s, quaternions x, y, z, w.

const GROWTH = 1.5;

/** Rows of one column, which can grow. */
class Column {
  constructor(values, width) {
    this.values = values;
    this.width = width;
    this.rows = values.length / width;
  }

  append(row) {
    const end = (this.rows + 1) * this.width;
    if (end > this.values.length) {
      const larger = new Float32Array(Math.ceil(GROWTH * end) + 100);
      larger.set(this.values);
      this.values = larger;
    }
    this.values.set(row, this.rows * this.width);
    this.rows += 1;
  }

  interpolate({ row, next, share }) {
    const found = [];
    for (let i = 0; i < this.width; ++i) {
      const before = this.values[row * this.width + i], after = this.values[next * this.width + i];
      found.push(share ? (1 - share) * before + share * after : before);
    }
    return found;
  }
}

export class Flight {
  constructor(content) {
    Object.assign(this, content, { shown: true });
    this.columns = {};
    for (const [name, { width, values }] of Object.entries(content.columns))
      this.columns[name] = new Column(values, width);
    this.payloads = Object.keys(this.columns).filter((name) => name.startsWith("payload "));
    this.limit = content.speed_limit ?? null;
    this.columns.rotor_angle = new Column(new Float32Array(0), this.rotors);
    this.#measure();
  }

  /** Find the usual speed of the rotors, and the angles that they turned by. */
  #measure() {
    const speeds = this.columns.rotor_velocity.values
      .slice(0, this.rows * this.rotors).map(Math.abs).sort();
    this.usualSpeed = speeds[speeds.length >> 1] || 1;  // median; 1 for a vehicle at rest
    const { time, rotor_velocity: turning, rotor_angle: angle } = this.columns;
    for (let row = angle.rows; row < this.rows; ++row) {
      const step = row ? time.values[row] - time.values[row - 1] : 0;
      angle.append(Array.from({ length: this.rotors }, (_, i) => {
        const [now, before] = [row, row - 1].map((at) => turning.values[this.rotors * at + i] || 0);
        return (row ? angle.values[this.rotors * (row - 1) + i] : 0) + step * (now + before) / 2;
      }));
    }
  }

  get rows() { return this.columns.time.rows; }
  get rotors() { return this.columns.rotor_velocity.width; }
  get begin() { return this.rows ? this.columns.time.values[0] : 0; }
  get end() { return this.rows ? this.columns.time.values[this.rows - 1] : 0; }

  /** Append rows of a flight that still goes on; each has the columns in `order`. */
  append(rows) {
    for (const row of rows) {
      let at = 0;
      for (const column of this.order.map((name) => this.columns[name])) {
        column.append(row.slice(at, at + column.width).map((value) => value ?? NaN));
        at += column.width;
      }
    }
    this.#measure();
  }

  /** Return the row at or before a time, the next row, and the share of the way to it. */
  place(t) {
    const times = this.columns.time.values;
    let low = 0, high = this.rows - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (times[middle] <= t) low = middle; else high = middle - 1;
    }
    const next = Math.min(low + 1, this.rows - 1);
    const span = times[next] - times[low];
    const share = span > 0 ? Math.min(1, Math.max(0, (t - times[low]) / span)) : 0;
    return { row: low, next, share };
  }

  at(t) {
    const place = this.place(t);
    const find = (name) => this.columns[name] && this.columns[name].interpolate(place);
    const orientation = this.columns.orientation.values;
    const ends = [place.row, place.next].map((row) => orientation.subarray(4 * row, 4 * row + 4));
    return {
      row: place.row,
      position: find("position"),
      orientation: slerp(ends[0], ends[1], place.share),
      speeds: find("rotor_velocity"),
      angles: find("rotor_angle"),
      reference: find("reference"),
      wind: find("wind"),
      payloads: this.payloads.map((name) => this.columns[name].interpolate({ ...place, share: 0 })),
      state: t < this.begin ? "not started" : t > this.end ? "ended" : "",
    };
  }
}

/** Interpolate between two unit quaternions at constant angular velocity. */
function slerp(a, b, share) {
  let cosine = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  const sign = cosine < 0 ? -1 : 1;
  cosine = Math.min(1, Math.abs(cosine));
  const angle = Math.acos(cosine);
  let [wa, wb] = [1 - share, share];
  if (angle > 1e-3) {
    wa = Math.sin((1 - share) * angle) / Math.sin(angle);
    wb = Math.sin(share * angle) / Math.sin(angle);
  }
  const mixed = [0, 1, 2, 3].map((i) => wa * a[i] + sign * wb * b[i]);
  const norm = Math.hypot(...mixed) || 1;
  return mixed.map((value) => value / norm);
}
