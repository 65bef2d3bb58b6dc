// States of the flights at any time.
// World axes are x, y, z with z up; lengths in m, times in s, quaternions x, y, z, w.

const root = document.currentScript.closest(".player");
const part = (name) => root.querySelector(name);
const content = JSON.parse(part(".content").textContent);

function unpacked(text) {
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  return new Float32Array(bytes.buffer);
}

class Flight {
  constructor({ name, rotors, columns }, colour, dash) {
    Object.assign(this, { name, rotors, colour, dash, shown: true });
    for (const column in columns) this[column] = unpacked(columns[column]);
    this.rows = this.time.length;
    this.carried = Object.keys(columns).filter((column) => column.startsWith("carried "));
    this.turning = this.rotor_velocity.length / this.rows;
    const speeds = this.rotor_velocity.map(Math.abs).sort();
    this.usual = speeds[speeds.length >> 1] || 1;  // median; 1 for a vehicle at rest
  }

  begin() { return this.time[0]; }
  end() { return this.time[this.rows - 1]; }

  // Row at or before a time, the next row, and the share of the way to it.
  place(t) {
    let low = 0, high = this.rows - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.time[middle] <= t) low = middle; else high = middle - 1;
    }
    const next = Math.min(low + 1, this.rows - 1);
    const span = this.time[next] - this.time[low];
    const share = span > 0 ? Math.min(1, Math.max(0, (t - this.time[low]) / span)) : 0;
    return { row: low, next, share };
  }

  // Values of a column, interpolated between two rows.
  between(column, width, { row, next, share }, sign = 1) {
    const values = [];
    for (let i = 0; i < width; ++i) {
      const a = column[row * width + i], b = column[next * width + i];
      values.push((1 - share) * a + share * sign * b);
    }
    return values;
  }

  at(t) {
    const place = this.place(t);
    const q = this.orientation, a = 4 * place.row, b = 4 * place.next;
    const same = q[a] * q[b] + q[a + 1] * q[b + 1] + q[a + 2] * q[b + 2] + q[a + 3] * q[b + 3];
    return {
      position: this.between(this.position, 3, place),
      turn: matrix(this.between(q, 4, place, same < 0 ? -1 : 1)),
      speeds: this.between(this.rotor_velocity, this.turning, place),
      reference: this.reference ? this.between(this.reference, 3, place) : null,
      wind: this.wind ? this.between(this.wind, 3, place) : null,
      carried: this.carried.map((name) => this.between(this[name], 4, { ...place, share: 0 })),
      row: place.row,
    };
  }
}

// Rows of the rotation matrix of a quaternion of any length.
function matrix([x, y, z, w]) {
  const s = 2 / (x * x + y * y + z * z + w * w);
  return [
    [1 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)],
    [s * (x * y + w * z), 1 - s * (x * x + z * z), s * (y * z - w * x)],
    [s * (x * z - w * y), s * (y * z + w * x), 1 - s * (x * x + y * y)],
  ];
}

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const difference = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];

const { colours, dashes } = content;
const flights = content.flights.map((flight, i) => new Flight(
  flight, colours[i % colours.length], dashes[Math.floor(i / colours.length) % dashes.length]));
const shown = () => flights.filter((flight) => flight.shown);
const begin = Math.min(...flights.map((flight) => flight.begin()));
const end = Math.max(...flights.map((flight) => flight.end()));
