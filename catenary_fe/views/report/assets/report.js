"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const $ = (id) => document.getElementById(id);

  /* ---- curves ---------------------------------------------------------------------------------- */

  function under(chart) {                       // evaluated part, supports, mean and mean ± 3σ
    return (u) => {
      const c = u.ctx, { left, top, width, height } = u.bbox;
      c.save();
      c.beginPath();
      c.rect(left, top, width, height);
      c.clip();
      const [a, b] = chart.band.map((v) => u.valToPos(v, "x", true));
      c.fillStyle = "#f3efe2";
      c.fillRect(a, top, b - a, height);
      c.strokeStyle = "#888";
      c.setLineDash([2, 4]);
      for (const x of chart.marks) line(c, u.valToPos(x, "x", true), top, 0, height);
      for (const l of chart.lines) {
        c.strokeStyle = l.colour;
        c.setLineDash(l.dashed ? [6, 5] : []);
        line(c, a, u.valToPos(l.value, "y", true), b - a, 0);
      }
      c.restore();
    };
  }

  function line(c, x, y, dx, dy) {
    c.beginPath();
    c.moveTo(x, y);
    c.lineTo(x + dx, y + dy);
    c.stroke();
  }

  function plot(id, chart, xLabel, yLabel, digits) {
    const box = $(id);
    const value = (decimals) => (u, v) => (v == null ? "–" : v.toFixed(decimals));
    const size = () => ({ width: box.clientWidth, height: Math.max(260, Math.min(380, box.clientWidth * 0.5)) });
    const u = new uPlot({
      ...size(),
      scales: { x: { time: false } },
      cursor: { drag: { x: true, y: false } },
      axes: [{ label: xLabel }, { label: yLabel, size: 60 }],
      series: [
        { label: xLabel, value: value(2) },
        ...chart.series.map((s) => ({
          label: s.label, stroke: s.faint ? (s.colour === "#999999" ? "#c4c4c4" : s.colour + "66") : s.colour,
          width: s.faint ? 1 : 1.6, show: s.shown, value: value(digits), points: { show: false },
        })),
      ],
      hooks: { drawClear: [under(chart)] },
    }, [chart.x, ...chart.series.map((s) => s.values)], box);
    const room = 0.02 * (chart.band[1] - chart.band[0]);
    for (const button of document.querySelectorAll(`[data-zoom="${id}"]`)) {
      button.addEventListener("click", () => {
        const all = button.dataset.to === "all";
        u.setScale("x", all ? { min: chart.x[0], max: chart.x[chart.x.length - 1] }
                            : { min: chart.band[0] - room, max: chart.band[1] + room });
      });
    }
    new ResizeObserver(() => u.setSize(size())).observe(box);
    return u;
  }

  /* ---- player ---------------------------------------------------------------------------------- */

  function decode(text, type) {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new type(bytes.buffer);
  }

  class Player {
    constructor(motion) {
      this.m = motion;
      for (const w of motion.wires) w.rows = decode(w.uplift, Int16Array);
      motion.droppers.slack = decode(motion.droppers.slack, Uint8Array);
      this.canvas = $("stage");
      this.time = motion.time[0];
      this.end = motion.time[motion.time.length - 1];
      this.playing = false;
      this.forceTop = 1.1 * Math.max(...motion.pantographs.map((p) => Math.max(...p.force)));
      this.range();
      this.whole = [motion.supports.x[0], motion.supports.x[motion.supports.x.length - 1]];
      this.controls();
      new ResizeObserver(() => this.draw()).observe(this.canvas);
      const first = Math.max(...motion.pantographs[0].x.slice(0, 1));
      this.seek(motion.time[this.frameWhere(motion.pantographs[0], Math.max(first, motion.band[0]))]);
    }

    frameWhere(pantograph, x) {
      const found = pantograph.x.findIndex((value) => value >= x);
      return found < 0 ? pantograph.x.length - 1 : found;
    }

    range() {                                   // heights of all that is drawn, in all frames
      const magnified = +$("magnified").value;
      let low = Infinity, high = -Infinity;
      const reach = (z) => { low = Math.min(low, z); high = Math.max(high, z); };
      for (const w of this.m.wires) {
        const n = w.x.length;
        w.rows.forEach((move, i) => {
          const rest = w.static[i % n];
          if (rest != null) reach(rest + magnified * w.unit * move);
        });
      }
      for (const p of this.m.pantographs) {
        p.rest.forEach((rest, frame) => {
          reach(rest);
          p.masses.forEach((m, n) => reach(this.massHeight(p, n, frame, magnified)));
        });
      }
      [this.low, this.high] = [low - this.m.mass_gap, high + this.m.mass_gap];
    }

    massHeight(p, n, frame, magnified) {        // below the wire at rest
      return p.rest[frame] - this.m.mass_gap * n + magnified * p.masses[n][frame];
    }

    controls() {
      const slider = $("time");
      slider.max = this.m.time.length - 1;
      slider.addEventListener("input", () => this.seek(this.m.time[+slider.value]));
      $("play").addEventListener("click", () => this.toggle());
      $("magnified").addEventListener("input", () => { this.range(); this.draw(); });
      $("view").addEventListener("input", () => this.draw());
    }

    toggle() {
      this.playing = !this.playing;
      $("play").textContent = this.playing ? "Pause" : "Play";
      if (!this.playing) return;
      if (this.time >= this.end) this.time = this.m.time[0];
      let before = performance.now();
      const step = (now) => {
        if (!this.playing) return;
        this.time += ((now - before) / 1000) / +$("slowed").value;
        before = now;
        if (this.time >= this.end) { this.time = this.end; this.toggle(); }
        this.draw();
        requestAnimationFrame(step);
      };
      requestAnimationFrame(step);
    }

    seek(time) {
      this.time = time;
      this.draw();
    }

    frame() {
      const t = this.m.time, n = Math.round((this.time - t[0]) / (t[1] - t[0]));
      return Math.max(0, Math.min(t.length - 1, n));
    }

    window(frame) {
      if ($("view").value === "line") return this.whole;
      const xs = this.m.pantographs.map((p) => p.x[frame]);
      const middle = (Math.min(...xs) + Math.max(...xs)) / 2;
      const width = Math.min(this.whole[1] - this.whole[0],
                             Math.max(+$("view").value, 1.5 * (Math.max(...xs) - Math.min(...xs))));
      const start = Math.max(this.whole[0], Math.min(this.whole[1] - width, middle - width / 2));
      return [start, start + width];
    }

    draw() {
      const canvas = this.canvas, ratio = window.devicePixelRatio || 1;
      const width = canvas.clientWidth, height = canvas.clientHeight;
      if (!width) return;
      if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
        canvas.width = Math.round(width * ratio);
        canvas.height = Math.round(height * ratio);
      }
      const c = canvas.getContext("2d");
      c.setTransform(ratio, 0, 0, ratio, 0, 0);
      c.clearRect(0, 0, width, height);
      const frame = this.frame(), [a, b] = this.window(frame), left = 46, right = 10, middle = height * 0.6;
      const X = (x) => left + (x - a) / (b - a) * (width - left - right);
      const Z = (z) => 8 + (this.high - z) / (this.high - this.low) * (middle - 16);
      const F = (f) => height - 34 - f / this.forceTop * (height - middle - 48);
      this.drawGrid(c, X, F, a, b, width, height, middle, left, right);
      c.save();
      c.beginPath();
      c.rect(left, 0, width - left - right, height);
      c.clip();
      const lines = this.drawWires(c, X, Z, frame, a, b);
      this.drawPantographs(c, X, Z, F, frame, lines, a, b);
      c.restore();
      this.say(frame, ((middle - 16) / (this.high - this.low)) / ((width - left - right) / (b - a)));
    }

    drawGrid(c, X, F, a, b, width, height, middle, left, right) {
      c.font = "11px system-ui, sans-serif";
      c.fillStyle = "#5b6773";
      c.strokeStyle = "#bbb";
      c.lineWidth = 1;
      c.setLineDash([2, 4]);
      for (const x of this.m.supports.x) if (x >= a && x <= b) line(c, X(x), 6, 0, height - 40);
      c.setLineDash([]);
      c.strokeStyle = "#e3e7ea";
      const force = niceStep(this.forceTop, 4), way = niceStep(b - a, Math.max(3, width / 110));
      c.textAlign = "right";
      for (let f = 0; f <= this.forceTop; f += force) {
        line(c, left, F(f), width - left - right, 0);
        c.fillText(f, left - 5, F(f) + 4);
      }
      c.textAlign = "center";
      for (let x = Math.ceil(a / way) * way; x <= b; x += way) c.fillText(x, X(x), height - 20);
      c.fillText("position along the line (m)", (left + width - right) / 2, height - 5);
      c.save();
      c.translate(11, (middle + height - 34) / 2);
      c.rotate(-Math.PI / 2);
      c.fillText("force (N)", 0, 0);
      c.restore();
    }

    drawWires(c, X, Z, frame, a, b) {
      const magnified = +$("magnified").value;
      const lines = this.m.wires.map((w) => {
        const n = w.x.length, z = new Array(n);
        for (let i = 0; i < n; i++) {
          z[i] = w.static[i] == null ? null : w.static[i] + magnified * w.unit * w.rows[frame * n + i];
        }
        return z;
      });
      const d = this.m.droppers;
      d.x.forEach((x, i) => {
        if (x < a || x > b) return;
        const slack = d.slack[frame * d.x.length + i];
        c.strokeStyle = slack ? "#d62728" : "#7a7a7a";
        c.lineWidth = slack ? 2 : 1;
        c.setLineDash(slack ? [3, 3] : []);
        const [z0, z1] = d.ends[i].map((w) => at(this.m.wires[w].x, lines[w], x));
        line(c, X(x), Z(z0), 0, Z(z1) - Z(z0));
      });
      c.setLineDash([]);
      this.m.wires.forEach((w, k) => {
        c.strokeStyle = w.colour;
        c.lineWidth = 1.7;
        c.beginPath();
        let pen = false;
        w.x.forEach((x, i) => {
          if (lines[k][i] == null) { pen = false; return; }
          if (pen) c.lineTo(X(x), Z(lines[k][i])); else c.moveTo(X(x), Z(lines[k][i]));
          pen = true;
        });
        c.stroke();
      });
      c.fillStyle = "#444";
      this.m.supports.x.forEach((x, i) => {
        const y = Z(this.m.supports.top[i]);
        c.beginPath();
        c.moveTo(X(x), y); c.lineTo(X(x) - 5, y - 9); c.lineTo(X(x) + 5, y - 9);
        c.fill();
      });
      return lines;
    }

    drawPantographs(c, X, Z, F, frame, lines, a, b) {
      const magnified = +$("magnified").value, contact = this.m.wires.findIndex((w) => w.touched);
      this.m.pantographs.forEach((p, k) => {
        const x = p.x[frame], head = at(this.m.wires[contact].x, lines[contact], x);
        c.strokeStyle = c.fillStyle = p.colour;
        c.lineWidth = 1.5;
        line(c, X(x), Z(head), 0, Z(this.low) - Z(head));
        c.fillRect(X(x) - 11, Z(head), 22, 5);
        p.masses.forEach((m, n) => {
          if (n) c.fillRect(X(x) - 6, Z(this.massHeight(p, n, frame, magnified)) - 5, 12, 10);
        });
        for (const [end, alpha] of [[b, 0.25], [Math.min(x, b), 1]]) {
          c.globalAlpha = alpha;
          this.drawForce(c, X, F, k, a, end);
        }
        c.globalAlpha = 1;
        c.beginPath();
        c.arc(X(x), F(p.force[frame]), 4.5, 0, 7);
        c.fill();
      });
    }

    drawForce(c, X, F, pantograph, start, end) {  // from the curve, which is finer than the frames
      const x = data.force.x, values = data.force.series.filter((s) => !s.faint)[pantograph].values;
      c.beginPath();
      let pen = false;
      for (let i = 0; i < x.length && x[i] <= end; i++) {
        if (x[i] < start || values[i] == null) continue;
        if (pen) c.lineTo(X(x[i]), F(values[i])); else c.moveTo(X(x[i]), F(values[i]));
        pen = true;
      }
      c.stroke();
    }

    say(frame, exaggeration) {
      $("time").value = frame;
      const forces = this.m.pantographs.map((p) => `${p.force[frame].toFixed(0)} N at ${p.x[frame].toFixed(0)} m`);
      const slack = this.m.droppers.slack.subarray(frame * this.m.droppers.x.length, (frame + 1) * this.m.droppers.x.length)
        .reduce((sum, v) => sum + v, 0);
      $("now").textContent = `t = ${this.m.time[frame].toFixed(2)} s: ${forces.join(", ")}; ${slack} droppers slack`;
      $("scale").textContent = `Heights are drawn ${exaggeration.toFixed(0)} times larger than lengths`
        + (+$("magnified").value > 1 ? `, the motion about the static shape another ${$("magnified").value} times.` : ".");
    }
  }

  function at(x, z, where) {                    // straight between the points
    let lo = 0, hi = x.length - 1;
    while (hi - lo > 1) { const mid = (lo + hi) >> 1; if (x[mid] <= where) lo = mid; else hi = mid; }
    const share = (where - x[lo]) / (x[hi] - x[lo]);
    return z[lo] + share * (z[hi] - z[lo]);
  }

  function niceStep(range, count) {
    const rough = range / count, power = 10 ** Math.floor(Math.log10(rough));
    return [1, 2, 5, 10].map((n) => n * power).find((s) => s >= rough);
  }

  const force = plot("force-chart", data.force, "position (m)", "contact force (N)", 1);
  window.charts = { force, uplift: plot("uplift-chart", data.uplift, "time (s)", "uplift (mm)", 1) };
  if (data.motion) {
    const player = window.player = new Player(data.motion);
    force.over.addEventListener("click", () => {
      const x = force.posToVal(force.cursor.left, "x");
      player.seek(data.motion.time[player.frameWhere(data.motion.pantographs[0], x)]);
    });
  }
})();
