'use strict';
// Curves of the last seconds, on a canvas: time at the right is now.
const SECONDS = 20;
const COLOURS = ['#58a6ff', '#3fb950', '#f5b041', '#ff6b5e', '#bc8cff', '#39c5cf'];

class Plot {
  constructor(canvas, colours) {
    this.canvas = canvas;
    this.colours = colours;
    this.rows = [];   // [seconds, value, value, …]
  }

  note(now, values) {
    this.rows.push([now, ...values]);
    while (this.rows[0][0] < now - SECONDS) this.rows.shift();
  }

  draw() {
    const { canvas, rows } = this;
    const scale = devicePixelRatio || 1, width = canvas.clientWidth, height = canvas.clientHeight;
    if (!width || rows.length < 2) return;
    canvas.width = width * scale; canvas.height = height * scale;
    const pen = canvas.getContext('2d');
    pen.scale(scale, scale);
    const all = rows.flatMap((row) => row.slice(1)).filter(Number.isFinite);
    if (!all.length) return;
    let low = Math.min(...all), high = Math.max(...all);
    if (high - low < 0.1) { const middle = (low + high) / 2; low = middle - 0.05; high = middle + 0.05; }
    const left = 46, bottom = height - 18, now = rows[rows.length - 1][0];
    const x = (t) => left + (width - left - 6) * (1 - (now - t) / SECONDS);
    const y = (v) => 8 + (bottom - 8) * (1 - (v - low) / (high - low));
    pen.font = '11px system-ui, sans-serif';
    pen.fillStyle = '#a8b3bf'; pen.strokeStyle = '#30363d'; pen.lineWidth = 1;
    pen.textAlign = 'right';
    for (const v of [low, (low + high) / 2, high]) {
      pen.beginPath(); pen.moveTo(left, y(v)); pen.lineTo(width - 6, y(v)); pen.stroke();
      pen.fillText(v.toFixed(high - low < 2 ? 2 : 1), left - 4, y(v) + 4);
    }
    pen.textAlign = 'center';
    for (const ago of [20, 10, 0]) pen.fillText(ago ? `−${ago} s` : 'now', Math.min(x(now - ago), width - 16), height - 4);
    this.colours.forEach((colour, k) => {
      pen.strokeStyle = colour; pen.lineWidth = 1.6; pen.beginPath();
      let isDrawing = false;
      for (const row of rows) {
        const v = row[k + 1];
        if (!Number.isFinite(v)) { isDrawing = false; continue; }
        if (isDrawing) pen.lineTo(x(row[0]), y(v)); else pen.moveTo(x(row[0]), y(v));
        isDrawing = true;
      }
      pen.stroke();
    });
  }
}
