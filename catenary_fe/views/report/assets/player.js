"use strict";
const makePlayer = (motion, force, chosen) => {
  const { $, line, niceStep, thinned } = charting;

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
      this.heads = [];                          // wire and drawn height [m] of each pantograph's head
      this.forceTop = 1.1 * Math.max(...motion.pantographs.map((p) => p.force.reduce((a, b) => Math.max(a, b))));
      this.range();
      this.whole = [motion.supports.x[0], motion.supports.x[motion.supports.x.length - 1]];
      this.controls();
      new ResizeObserver(() => this.draw()).observe(this.canvas);
    }

    goTo([begin]) {                             // the leading pantograph to a place [m], or where it starts
      const leading = this.m.pantographs[0];
      this.seek(this.m.time[this.frameWhere(leading, Math.max(leading.x[0], begin))]);
    }

    design(x) {                                 // [m] straight between the supports
      return at(this.m.supports.x, this.m.supports.design, x);
    }

    ramp(a, b) {                                // [m] lowest and highest design height between two places
      const s = this.m.supports, inside = s.design.filter((_, i) => s.x[i] > a && s.x[i] < b);
      const all = [this.design(a), this.design(b), ...inside];
      return [Math.min(...all), Math.max(...all)];
    }

    frameWhere(pantograph, x) {
      const found = pantograph.x.findIndex((value) => value >= x);
      return found < 0 ? pantograph.x.length - 1 : found;
    }

    range() {                                   // heights about the design line of what is drawn, in all frames
      const magnified = +$("magnified").value;
      let low = Infinity, high = -Infinity;
      const reach = (z) => { low = Math.min(low, z); high = Math.max(high, z); };
      const s = this.m.supports;
      s.top.forEach((top, i) => reach(top - s.design[i]));
      for (const w of this.m.wires.filter((each) => each.touched)) {
        const n = w.x.length, rest = w.static.map((z, i) => (z == null ? null : z - this.design(w.x[i])));
        w.rows.forEach((move, i) => {           // what runs off to its anchor may leave the picture
          if (rest[i % n] != null && rest[i % n] < 0.3) reach(rest[i % n] + magnified * w.unit * move);
        });
      }
      for (const p of this.m.pantographs) {
        p.rest.forEach((rest, frame) => {
          const line = this.design(p.x[frame]);
          reach(rest - line);
          p.masses.forEach((m, n) => reach(this.massHeight(p, n, frame, magnified) - line));
        });
      }
      this.about = [low - this.m.mass_gap, high + this.m.mass_gap];
    }

    /* Lowest and highest height [m] of the picture: they follow the wire down and up a ramp, and lie as far
       apart in all frames of a view, so that the scale of heights stays what it is. */
    heights(a, b) {
      const s = this.m.supports, width = b - a - 1e-6;
      let most = 0;
      for (const x of s.x) {
        for (const start of [x, x - width]) {
          const from = Math.max(this.whole[0], Math.min(this.whole[1] - width, start));
          const [low, high] = this.ramp(from, from + width);
          most = Math.max(most, high - low);
        }
      }
      const [low, high] = this.ramp(a, b), middle = (low + high) / 2;
      return [middle - most / 2 + this.about[0], middle + most / 2 + this.about[1]];
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
      if ($("view").value === "chosen") return chosen();
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
      [this.low, this.high] = this.heights(a, b);
      const X = (x) => left + (x - a) / (b - a) * (width - left - right);
      const Z = (z) => 18 + (this.high - z) / (this.high - this.low) * (middle - 26);
      const F = (f) => height - 34 - f / this.forceTop * (height - middle - 48);
      this.drawGrid(c, X, F, a, b, width, height, middle, left, right);
      this.drawHeights(c, Z, left, width - left - right, middle);
      c.save();
      c.beginPath();
      c.rect(left, 0, width - left - right, height);
      c.clip();
      const lines = this.drawWires(c, X, Z, frame, a, b);
      this.drawPantographs(c, X, Z, F, frame, lines, a, b);
      c.restore();
      this.say(frame, ((middle - 26) / (this.high - this.low)) / ((width - left - right) / (b - a)));
    }

    drawGrid(c, X, F, a, b, width, height, middle, left, right) {
      c.font = "11px system-ui, sans-serif";
      c.fillStyle = "#5b6773";
      c.strokeStyle = this.m.colours.support + "88";
      c.lineWidth = 1;
      c.setLineDash([2, 4]);
      for (const x of this.m.supports.x) if (x >= a && x <= b) line(c, X(x), 18, 0, height - 52);
      c.setLineDash([]);
      c.textAlign = "center";
      const places = this.m.supports.x.map(X);
      for (const n of thinned(places, 26)) {
        if (places[n - 1] > left - 1 && places[n - 1] < width - right + 1) c.fillText(n, places[n - 1], 12);
      }
      c.strokeStyle = "#e3e7ea";
      const force = niceStep(this.forceTop, 4), way = niceStep(b - a, Math.max(3, width / 110));
      c.textAlign = "right";
      for (let f = 0; f <= this.forceTop; f += force) {
        line(c, left, F(f), width - left - right, 0);
        c.fillText(f, left - 5, F(f) + 4);
      }
      c.textAlign = "center";
      for (let x = Math.ceil(a / way) * way; x <= b; x += way) c.fillText(x, Math.min(X(x), width - 16), height - 20);
      c.fillText("position along the line (m)", (left + width - right) / 2, height - 5);
      c.save();
      c.translate(11, (middle + height - 34) / 2);
      c.rotate(-Math.PI / 2);
      c.fillText("force (N)", 0, 0);
      c.restore();
    }

    drawHeights(c, Z, left, wide, middle) {     // [m] above the rail
      const step = niceStep(this.high - this.low, 4), digits = step < 0.1 ? 2 : 1;
      c.textAlign = "right";
      for (let z = Math.ceil(this.low / step) * step; z <= this.high; z += step) {
        line(c, left, Z(z), wide, 0);
        c.fillText(z.toFixed(digits), left - 5, Z(z) + 4);
      }
      c.textAlign = "center";
      c.save();
      c.translate(11, middle / 2);
      c.rotate(-Math.PI / 2);
      c.fillText("height (m)", 0, 0);
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
        c.strokeStyle = slack ? this.m.colours.slack : this.m.colours.dropper;
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
      c.fillStyle = this.m.colours.support;
      this.m.supports.x.forEach((x, i) => {
        const y = Z(this.m.supports.top[i]);
        c.beginPath();
        c.moveTo(X(x), y); c.lineTo(X(x) - 5, y - 9); c.lineTo(X(x) + 5, y - 9);
        c.fill();
      });
      return lines;
    }

    drawPantographs(c, X, Z, F, frame, lines, a, b) {
      const magnified = +$("magnified").value;
      this.m.pantographs.forEach((p, k) => {
        const x = p.x[frame], wire = this.wireAbove(x, frame), head = at(this.m.wires[wire].x, lines[wire], x);
        this.heads[k] = { wire, height: head };
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

    wireAbove(x, frame) {                       // number of the lowest contact wire there, as it really moves
      let found = -1, lowest = Infinity;
      this.m.wires.forEach((w, k) => {
        const n = w.x.length;
        if (!w.touched || x < w.x[0] || x > w.x[n - 1]) return;
        const rest = at(w.x, w.static, x), z = rest + w.unit * at(w.x, w.rows.subarray(frame * n, (frame + 1) * n), x);
        if (z < lowest) [found, lowest] = [k, z];
      });
      return found;
    }

    drawForce(c, X, F, pantograph, start, end) {  // from the curve, which is finer than the frames
      const x = force.x, values = force.series.filter((s) => !s.faint)[pantograph].values;
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

  return new Player(motion);
};
