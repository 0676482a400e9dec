// Numbers in the panel.

const count = new Intl.NumberFormat('en');

function fill(table, row, values) {
  const cells = document.querySelectorAll(`#${table} tbody tr`)[row].querySelectorAll('td');
  values.forEach((value, side) => { cells[side].textContent = value; });
}

/** What the last frame came to, as Rust gives it for each side. */
export function showStatistics(sides) {
  fill('statistics', 0, sides.map(([drawn]) => drawn || 'nothing'));
  fill('statistics', 1, sides.map(([, draws]) => count.format(draws)));
  fill('statistics', 2, sides.map(([, , triangles]) => count.format(triangles)));
  fill('statistics', 3, sides.map(([, , , bytes]) => `${(bytes / 2 ** 20).toFixed(1)} MiB`));
}

/** Milliseconds from frame to frame, while there are frames. */
export function showFrameTime(milliseconds) {
  const text = milliseconds ? `${milliseconds.toFixed(1)} ms a frame` : '';
  document.getElementById('frame-time').textContent = text;
}

/** Pixels of each side: counted, lit in shadow, in shadow though lit, far from edges; `null`: unknown. */
export function showErrors(sides, of, part) {
  const share = (wrong, counted) => `${(100 * wrong / Math.max(counted, 1)).toFixed(3)} %`;
  const rows = sides?.map(([counted, lit, shadow, interior]) => [
    share(lit + shadow, counted), share(lit, counted), share(shadow, counted), count.format(interior),
  ]) ?? [['–', '–', '–', '–'], ['–', '–', '–', '–']];
  for (let row = 0; row < 4; row += 1) fill('errors', row, rows.map((values) => values[row]));
  document.getElementById('measured').textContent = of;
  document.getElementById('progress').value = part;
}
