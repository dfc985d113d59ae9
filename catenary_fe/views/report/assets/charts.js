"use strict";
/* Curves, and what they share with the player: data.js is the page's JSON, places are metres along the line. */
const data = JSON.parse(document.getElementById("data").textContent);
const charting = (() => {
  const $ = (id) => document.getElementById(id);

  function line(c, x, y, dx, dy) {
    c.beginPath();
    c.moveTo(x, y);
    c.lineTo(x + dx, y + dy);
    c.stroke();
  }

  function niceStep(range, count) {
    const rough = range / count, power = 10 ** Math.floor(Math.log10(rough));
    return [1, 2, 5, 10].map((n) => n * power).find((s) => s >= rough);
  }

  function thinned(places, least) {             // numbers (from 1) of rising places that stay so far apart
    const near = places.length > 1
      ? Math.min(...places.slice(1).map((x, i) => x - places[i])) : Infinity;
    const step = [1, 2, 5, 10, 20, 50, 100, 200, 500].find((n) => n * near >= least) || 1000;
    return places.map((_, i) => i + 1).filter((n) => n % step === 0);
  }

  function under(chart) {                       // evaluated part, supports, mean and mean ± 3σ
    return (u) => {
      const c = u.ctx, ratio = uPlot.pxRatio, { left, top, width, height } = u.bbox;
      c.save();
      c.beginPath();
      c.rect(left, top, width, height);
      c.clip();
      const [a, b] = chart.band.map((v) => u.valToPos(v, "x", true));
      c.fillStyle = "#f3efe2";
      if (chart.band.length) c.fillRect(a, top, b - a, height);
      c.strokeStyle = "#666";
      c.setLineDash([2 * ratio, 4 * ratio]);
      const places = chart.marks.map((x) => u.valToPos(x, "x", true));
      for (const x of places) line(c, x, top, 0, height);
      for (const l of chart.lines) {
        c.strokeStyle = l.colour;
        c.setLineDash(l.dashed ? [6 * ratio, 5 * ratio] : []);
        const [from, to] = l.whole ? [left, left + width] : [a, b];
        line(c, from, u.valToPos(l.value, "y", true), to - from, 0);
      }
      c.fillStyle = "#222";
      c.font = `${11 * ratio}px system-ui, sans-serif`;
      c.textAlign = "center";
      for (const n of thinned(places, 26 * ratio)) c.fillText(n, places[n - 1], top + 11 * ratio);
      c.restore();
    };
  }

  function plot(id, chart, xLabel, yLabel, digits) {
    const box = $(id), phone = box.clientWidth < 500;
    const value = (decimals) => (u, v) => (v == null ? "–" : v.toFixed(decimals));
    const size = () => ({ width: box.clientWidth, height: Math.max(260, Math.min(380, box.clientWidth * 0.5)) });
    const room = (u, low, high) => {            // above the curves, for the numbers of the supports
      if (low == null) return [0, 1];
      const least = 10 ** -digits, more = 0.08 * Math.max(high - low, least);
      return [low - more, high + (chart.marks.length ? 2.2 : 1) * more];
    };
    const u = new uPlot({
      ...size(),
      scales: { x: { time: false }, y: { range: room } },
      cursor: { drag: { x: true, y: false } },
      axes: [{ label: xLabel, space: phone ? 60 : 50 }, { label: yLabel, size: phone ? 48 : 60 }],
      series: [
        { label: xLabel, value: value(2) },
        ...chart.series.map((s) => ({
          label: s.label, stroke: s.faint ? s.colour + "66" : s.colour,
          width: s.faint ? 1 : 1.6, show: s.shown, value: value(digits), points: { show: false },
        })),
      ],
      hooks: { drawClear: [under(chart)] },
    }, [chart.x, ...chart.series.map((s) => s.values)], box);
    new ResizeObserver(() => u.setSize(size())).observe(box);
    return u;
  }

  function show(u, range) {                     // a stretch of the x axis with a little room; null: all
    const x = u.data[0], least = x[0], most = x[x.length - 1];
    const [a, b] = range || [least, most], room = range ? 0.02 * (b - a) : 0;
    const [min, max] = [Math.max(least, a - room), Math.min(most, b + room)];
    u.setScale("x", min < max ? { min, max } : { min: least, max: most });
  }

  return { $, line, niceStep, thinned, plot, show };
})();
