"use strict";
(() => {
  const { $, plot, show } = charting, spans = data.spans, count = spans.supports.length - 1;

  const force = plot("force-chart", data.force, "position (m)", "contact force (N)", 1);
  const uplift = plot("uplift-chart", data.uplift, "time (s)", "uplift (mm)", 1);
  const heights = plot("heights-chart", data.heights, "position (m)", "height above rail (m)", 3);
  const plan = data.plan && plot("plan-chart", data.plan, "position (m)", "to the left of the track (m)", 3);
  window.charts = { force, uplift, heights, plan };

  /* ---- the spans that curves, tables and player show --------------------------------------------- */

  const chooser = $("spans");
  let chosen = spans.evaluated;

  function place(first, last) {                 // [m]
    return [spans.supports[first - 1], spans.supports[last]];
  }

  function inWords(numbers) {
    const first = numbers[0], last = numbers[numbers.length - 1];
    return last - first === numbers.length - 1 && numbers.length > 2 ? `${first} to ${last}` : numbers.join(", ");
  }

  function fillChooser() {
    const every = spans.supports.slice(1).map((_, i) => i + 1);
    const entries = [["evaluated", `evaluated: ${inWords(spans.evaluated)}`], ["all", `all: ${inWords(every)}`],
                     ...every.map((n) => [n, `span ${n}`])];
    for (const [value, text] of entries) chooser.add(new Option(text, value));
    return { evaluated: spans.evaluated, all: every };
  }

  function when(numbers) {                      // [s] from the first pantograph's entry to the last one's exit
    const times = numbers.map((n) => spans.passed[n - 1]).filter((t) => t);
    return times.length ? [Math.min(...times.map((t) => t[0])), Math.max(...times.map((t) => t[1]))] : null;
  }

  function choose() {
    chosen = groups[chooser.value] || [+chooser.value];
    const first = chosen[0], last = chosen[chosen.length - 1], all = chooser.value === "all";
    const range = all ? null : place(first, last), has = new Set(chosen);
    for (const u of [force, heights, plan]) if (u) show(u, range);
    show(uplift, all ? null : when(chosen));
    data.uplift.series.forEach((s, i) => {
      const wanted = s.spans.some((n) => has.has(n));
      if (uplift.series[i + 1].show !== wanted) uplift.setSeries(i + 1, { show: wanted });
      uplift.root.querySelectorAll(".u-series")[i + 1].classList.toggle("unchosen", !wanted);
    });
    const shown = uplift.series.filter((s) => s.show).length - 1;
    uplift.root.classList.toggle("crowded", shown > 12);
    for (const table of document.querySelectorAll(".of-spans")) {
      let rows = 0;
      for (const row of table.querySelectorAll("tr[data-spans]")) {
        const [a, b] = row.dataset.spans.split(" ").map(Number);
        row.hidden = !chosen.some((n) => a <= n && n <= b);
        rows += !row.hidden;
      }
      table.querySelector(".none").hidden = rows > 0;
    }
    const [a, b] = place(first, last);
    $("chosen").textContent = `${a} to ${b} m`;
    $("before").disabled = first === 1 && last !== count;
    $("after").disabled = last === count && first !== 1;
    if (window.player) player.goTo(place(first, last));
  }

  function step(way) {                          // to the span before or behind the chosen ones
    const next = way < 0 ? chosen[0] - 1 : chosen[chosen.length - 1] + 1;
    chooser.value = Math.min(count, Math.max(1, next));
    choose();
  }

  const groups = fillChooser();
  chooser.addEventListener("input", choose);
  $("before").addEventListener("click", () => step(-1));
  $("after").addEventListener("click", () => step(1));

  if (data.motion) {
    const player = window.player = makePlayer(data.motion, data.force, () => place(chosen[0], chosen[chosen.length - 1]));
    force.over.addEventListener("click", () => {
      const x = force.posToVal(force.cursor.left, "x");
      player.seek(data.motion.time[player.frameWhere(data.motion.pantographs[0], x)]);
    });
  }
  choose();
})();
