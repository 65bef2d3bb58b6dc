// A flight that still goes on: rows arrive as server-sent events.

/** Listen for rows. A reconnect doubles none: each event has the number of its first row. */
export function listen(url, flights, onrows, onend) {
  const source = new EventSource(url);
  source.addEventListener("rows", (event) => {
    const { flight, first, rows } = JSON.parse(event.data);
    const missing = flights[flight].rows - first;
    if (missing < 0 || missing >= rows.length) return;
    flights[flight].append(rows.slice(missing));
    onrows(flights[flight]);
  });
  source.addEventListener("end", (event) => {
    source.close();
    onend(JSON.parse(event.data).reason);
  });
  return source;
}
