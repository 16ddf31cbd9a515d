"use strict";
(function () {
  const data = JSON.parse(document.getElementById("data").textContent);
  const settings = data.settings;
  const by = (id) => document.getElementById(id);
  document.documentElement.classList.add("scripted");

  /* ---- sortable tables: a click on a heading, ascending first ---- */
  function value(row, column) {
    const cell = row.cells[column];
    const number = cell.dataset.v;
    if (number === undefined) return cell.textContent.toLowerCase();
    return number === "" ? Infinity : Number(number);
  }
  function sort(table, column, direction) {
    const body = table.tBodies[0];
    const rows = Array.from(body.rows);
    rows.sort(function (a, b) {
      const x = value(a, column), y = value(b, column);
      return (x < y ? -1 : x > y ? 1 : 0) * direction;
    });
    rows.forEach((row) => body.appendChild(row));
    Array.from(table.tHead.rows[0].cells).forEach(function (head, i) {
      if (i === column) head.setAttribute("aria-sort", direction > 0 ? "ascending" : "descending");
      else head.removeAttribute("aria-sort");
    });
  }
  document.querySelectorAll("table.sortable").forEach(function (table) {
    Array.from(table.tHead.rows[0].cells).forEach(function (head, column) {
      const button = document.createElement("button"); // so that the keyboard reaches it
      button.type = "button";
      button.textContent = head.textContent;
      head.textContent = "";
      head.appendChild(button);
      button.addEventListener("click", function () {
        sort(table, column, head.getAttribute("aria-sort") === "ascending" ? -1 : 1);
      });
    });
    if (table.dataset.sort) sort(table, Number(table.dataset.sort), 1);
  });

  /* ---- passes and work of one setting ---- */
  function element(name, text, parent) {
    const e = document.createElement(name);
    e.textContent = text;
    if (parent) parent.appendChild(e);
    return e;
  }
  function number(text, row) {
    element("td", text, row).className = "n";
  }
  const count = (n) => n === 0 ? "\u00b7" : String(n).replace(/\B(?=(\d{3})+$)/g, "\u202f");
  function showPasses(setting) {
    const table = by("pass-table");
    table.textContent = "";
    const head = element("tr", "", table.createTHead());
    element("th", "Pass", head);
    ["ms", "%"].concat(data.work_names).forEach((name) => { element("th", name, head).className = "n"; });
    const body = table.createTBody();
    const whole = setting.passes.reduce((sum, pass) => sum + (pass.ms || 0), 0);
    setting.passes.forEach(function (pass) {
      const row = body.insertRow();
      element("th", pass.name, row).scope = "row";
      number(pass.ms === null ? "\u2013" : pass.ms.toFixed(pass.ms < 1 ? 3 : 2), row);
      number(whole > 0 && pass.ms !== null ? (100 * pass.ms / whole).toFixed(1) : "\u2013", row);
      pass.work.forEach((n) => number(count(n), row));
    });
    const last = element("tr", "", table.createTFoot());
    element("th", "All passes", last).scope = "row";
    number(whole.toFixed(2), last);
    number("", last);
    data.work_names.forEach((name, i) => number(count(setting.passes.reduce((sum, pass) => sum + pass.work[i], 0)), last));
    by("values").textContent = setting.values;
  }

  /* ---- pictures ---- */
  const shown = Array.from(document.querySelectorAll(".shown")).map((s) => Number(s.dataset.setting));
  function showPictures(index) {
    const kind = by("error-kind").value;
    const setting = settings[index];
    by("wipe-frame").src = by("chosen-frame").src = by("frame-" + index).src;
    by("wipe-reference").src = by("reference").src;
    by("chosen-error").src = by(kind + "-" + index).src;
    by("chosen-caption").textContent = (kind === "signed" ? "Signed" : "Squared") + " error of \u201c" + setting.name + "\u201d: NMSE " +
      setting.total.nmse.toPrecision(3) + ", relMSE " + setting.total.relmse.toPrecision(3);
  }
  function wipe(percent) {
    by("wipe").value = percent;
    by("wiped").style.setProperty("--at", percent + "%");
  }
  function option(select, index) {
    element("option", index + "  " + settings[index].name, select).value = index;
  }
  if (shown.length) {
    shown.forEach((index) => option(by("picture"), index));
    by("picture").addEventListener("change", (e) => choose(Number(e.target.value)));
    by("error-kind").addEventListener("change", () => showPictures(Number(by("picture").value)));
    by("wipe").addEventListener("input", (e) => wipe(e.target.value));
    const drag = function (e) {
      if (e.type !== "pointerdown" && e.buttons === 0) return;
      const box = by("wiped").getBoundingClientRect();
      wipe(Math.max(0, Math.min(100, 100 * (e.clientX - box.left) / box.width)));
    };
    by("wiped").addEventListener("pointerdown", drag);
    by("wiped").addEventListener("pointermove", drag);
    showPictures(shown[0]);
  }

  /* ---- one chosen setting everywhere ---- */
  function choose(index) {
    document.querySelectorAll(".chosen").forEach((e) => e.classList.remove("chosen"));
    document.querySelectorAll('[data-setting="' + index + '"], [data-point="' + index + '"]').forEach((e) => e.classList.add("chosen"));
    by("setting").value = index;
    showPasses(settings[index]);
    if (shown.includes(index)) {
      by("picture").value = index;
      showPictures(index);
    }
  }
  settings.forEach((setting, index) => option(by("setting"), index));
  by("setting").addEventListener("change", (e) => choose(Number(e.target.value)));
  document.querySelectorAll("tr[data-setting], .key li").forEach(function (row) {
    row.addEventListener("click", () => choose(Number(row.dataset.setting)));
  });

  /* ---- names for the dots: gnuplot draws each set of data in its order ---- */
  function name(use, index) {
    const s = settings[index];
    const title = document.createElementNS("http://www.w3.org/2000/svg", "title");
    title.textContent = s.name + "\n" + s.ms.toPrecision(3) + " ms, NMSE " + s.total.nmse.toPrecision(3) + ", relMSE " + s.total.relmse.toPrecision(3);
    use.appendChild(title);
    use.dataset.point = index;
    use.addEventListener("click", () => choose(index));
  }
  document.querySelectorAll("figure[data-others]").forEach(function (figure) {
    const svg = figure.querySelector("svg");
    if (!svg) return;
    const words = (text) => text.split(" ").filter(Boolean).map(Number);
    [[1, words(figure.dataset.others)], [3, words(figure.dataset.front)], [4, [0]], [5, words(figure.dataset.elsewhere)]].forEach(function (set) {
      const uses = svg.querySelectorAll("#" + svg.id + "-gnuplot_plot_" + set[0] + " use");
      if (uses.length === set[1].length) uses.forEach((use, i) => name(use, set[1][i]));
    });
  });
  choose(0);
})();
