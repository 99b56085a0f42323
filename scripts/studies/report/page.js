// What moves on the page of a run: values under the pointer, the film, the rays of a pixel, the difference of
// two pictures. Without it the page still shows everything that stands still.
"use strict";
(async () => {
  const $ = id => document.getElementById(id);
  const KINDS = {primary: "#f2c14e", reflected: "#4ea5f2", refracted: "#62c462", shadow: "#b07cd8", memo: "#b07cd8"};

  // The page's data: JSON, deflated, as base64.
  async function unpacked(text) {
    const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
    const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
    return JSON.parse(await new Response(stream).text());
  }
  const data = await unpacked($("data").textContent.trim());
  const {width, height, wide, high} = data;  // cells; pixels of the picture

  const make = (name, attributes, ...children) => {
    const element = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    element.append(...children);
    return element;
  };
  const short = value => Number.isInteger(value) ? value.toLocaleString("en").replaceAll(",", "\u202f")
                                                 : value.toPrecision(4);
  const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

  // ---- values under the pointer

  const tip = make("div", {id: "tip", role: "status"});
  document.body.append(tip);
  // `text(column, row)` of the block under the pointer, among columns x rows of them.
  function tell(element, columns, rows, text) {
    element.addEventListener("pointermove", event => {
      const box = element.getBoundingClientRect();
      const column = clamp(Math.floor((event.clientX - box.left) / box.width * columns), 0, columns - 1);
      const row = clamp(Math.floor((event.clientY - box.top) / box.height * rows), 0, rows - 1);
      tip.textContent = text(column, row);
      tip.style.display = "block";
      tip.style.left = Math.min(event.clientX + 14, innerWidth - tip.offsetWidth - 4) + "px";
      tip.style.top = Math.min(event.clientY + 14, innerHeight - tip.offsetHeight - 4) + "px";
    });
    element.addEventListener("pointerleave", () => { tip.style.display = "none"; });
  }
  for (const image of document.querySelectorAll("img[data-map]")) {
    const values = data.maps[image.dataset.map];
    tell(image, width, height, (x, y) => `(${x}, ${y}): ${short(values[y * width + x])}`);
  }

  // ---- the film

  const shades = data.palette.map(colour => [1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16)));
  function shade(share) {
    const at = clamp(share, 0, 1) * (shades.length - 1), low = Math.min(Math.floor(at), shades.length - 2);
    return shades[low].map((value, i) => value + (shades[low + 1][i] - value) * (at - low));
  }
  // The frame with the largest sum.
  function busiest(changes, size) {
    const map = new Uint32Array(size);
    let sum = 0, most = 0, found = changes.length - 1;
    changes.forEach((frame, at) => {
      for (let i = 0; i < frame.length; i += 2) {
        sum += frame[i + 1] - map[frame[i]];
        map[frame[i]] = frame[i + 1];
      }
      if (sum > most) { most = sum; found = at; }
    });
    return found;
  }
  class Film {
    constructor(film) {
      this.film = film;
      this.size = film.columns * film.rows;
      this.at = -1;
      this.layers = Object.entries(film.layers).map(([name, changes]) => {
        let most = 0;
        for (const frame of changes) for (let i = 1; i < frame.length; i += 2) most = Math.max(most, frame[i]);
        if (name === "rays") this.busiest = busiest(changes, this.size);
        return {name, changes, most, map: new Uint32Array(this.size)};
      }).filter(layer => layer.most > 0);
      const places = $("film-maps");
      for (const layer of this.layers) {
        layer.canvas = make("canvas", {width: film.columns, height: film.rows, style: places.dataset.shape,
                                       "data-layer": layer.name, role: "img"});
        layer.sum = make("p", {});
        places.append(make("figure", {class: "map"},
            make("figcaption", {}, `${data.film_names[layer.name]}, up to ${short(layer.most)}`), layer.canvas, layer.sum));
        tell(layer.canvas, film.columns, film.rows, (x, y) => this.words(layer, x, y));
        layer.canvas.addEventListener("click", event => choose_under(event, layer.canvas));
      }
      const slider = $("film-time");
      slider.max = film.cycles.length - 1;
      slider.addEventListener("input", () => this.show(Number(slider.value)));
      $("film-play").addEventListener("click", () => this.play());
    }
    words(layer, x, y) {
      const n = this.film.cells_per_block, value = layer.map[y * this.film.columns + x];
      const last = (at, limit) => Math.min(at * n + n, limit) - 1;
      const where = n === 1 ? `(${x}, ${y})` : `(${x * n}..${last(x, width)}, ${y * n}..${last(y, height)})`;
      return `${where}: ${short(value)}`;
    }
    show(frame) {
      frame = clamp(frame, 0, this.film.cycles.length - 1);
      for (const layer of this.layers) {
        // The film has changes alone, so going back starts again from its beginning.
        let from = this.at + 1;
        if (frame < this.at) { layer.map.fill(0); from = 0; }
        for (let f = from; f <= frame; ++f) {
          const changes = layer.changes[f];
          for (let i = 0; i < changes.length; i += 2) layer.map[changes[i]] = changes[i + 1];
        }
        const context = layer.canvas.getContext("2d");
        const picture = context.createImageData(this.film.columns, this.film.rows);
        let sum = 0;
        layer.map.forEach((value, i) => {
          sum += value;
          picture.data.set([...shade(Math.sqrt(value / layer.most)), 255], 4 * i);
        });
        context.putImageData(picture, 0, 0);
        layer.sum.textContent = `${short(sum)} in all`;
      }
      this.at = frame;
      const cycle = this.film.cycles[frame];
      $("film-time").value = frame;
      $("film-now").textContent = `cycle ${short(cycle)}, ${this.film.phases[frame]}`;
      for (const chart of document.querySelectorAll("svg[data-start]")) move_cursor(chart, cycle);
      remember();
    }
    play() {
      if (this.timer) { clearInterval(this.timer); this.timer = null; $("film-play").textContent = "Play"; return; }
      if (this.at + 1 >= this.film.cycles.length) this.show(0);
      $("film-play").textContent = "Stop";
      this.timer = setInterval(() => {
        if (this.at + 1 >= this.film.cycles.length) this.play(); else this.show(this.at + 1);
      }, 50);
    }
  }
  function move_cursor(chart, cycle) {
    const {start, end, left, right} = chart.dataset;
    const share = (cycle - start) / (end - start);
    const cursor = chart.querySelector(".cursor");
    const x = Number(left) + share * (right - left);
    cursor.setAttribute("x1", x);
    cursor.setAttribute("x2", x);
    cursor.style.display = share >= 0 && share <= 1 ? "" : "none";
  }

  // ---- from a pixel to its rays

  function choose_under(event, element) {
    if (!data.rays) return;
    const box = element.getBoundingClientRect();
    choose(clamp(Math.floor((event.clientX - box.left) / box.width * wide), 0, wide - 1),
           clamp(Math.floor((event.clientY - box.top) / box.height * high), 0, high - 1));
  }
  let chosen = null;
  const children = new Map(), roots = new Map();  // row numbers by parent's row and by pixel
  const put = (map, key, value) => { if (map.has(key)) map.get(key).push(value); else map.set(key, [value]); };
  function choose(x, y) {
    chosen = [x, y];
    $("ray-x").value = x;
    $("ray-y").value = y;
    const tree = $("ray-tree"), lines = $("ray-lines"), top = roots.get(y * wide + x);
    tree.replaceChildren();
    lines.replaceChildren();
    if (!top) {
      tree.append(`No rays of pixel (${x}, ${y}) are in this page.`);
    } else {
      const body = make("tbody", {});
      const heads = ["ray", "from", "ended in", "cycles", "took", "hops", "of answers", "waited", "postponed"];
      tree.append(make("table", {}, make("thead", {}, make("tr", {}, ...heads.map(h => make("th", {}, h)))), body));
      top.forEach(row => add_ray(body, lines, row, 0));
      const across = width / wide, down = height / high;  // of a pixel, in cells
      lines.append(svg("rect", {x: x * across, y: y * down, width: across, height: down, class: "chosen"}));
    }
    remember();
  }
  function svg(name, attributes) {
    const element = document.createElementNS($("ray-lines").namespaceURI, name);
    for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
    return element;
  }
  function add_ray(body, lines, row, depth) {
    const r = Object.fromEntries(Object.entries(data.rays).map(([name, column]) => [name, column[row]]));
    const home = r.ended >= 0;
    const cells = [
      make("span", {class: "kind", style: `margin-left:${depth * 1.1}rem;border-color:${KINDS[r.kind]}`}, r.kind),
      `(${r.home_x}, ${r.home_y})`, `${r.end || "on its way"} (${r.end_x}, ${r.end_y})`,
      `${short(r.launched)} – ${home ? short(r.ended) : "not home"}`, home ? short(r.ended - r.launched) : "",
      r.hops, r.answer_hops, short(r.waited), r.postponed];
    const line = make("tr", {title: `ray ${r.ray}`}, ...cells.map((cell, i) => make("td", i > 3 ? {class: "number"} : {}, cell)));
    body.append(line);
    if (r.home_x !== r.end_x || r.home_y !== r.end_y) {
      lines.append(svg("line", {x1: r.home_x + .5, y1: r.home_y + .5, x2: r.end_x + .5, y2: r.end_y + .5,
                                stroke: KINDS[r.kind], "vector-effect": "non-scaling-stroke"}));
    }
    (children.get(row) || []).forEach(child => add_ray(body, lines, child, depth + 1));
  }

  // ---- two pictures

  function difference() {
    const context_of = element => {
      const canvas = make("canvas", {width: wide, height: high});
      const context = canvas.getContext("2d", {willReadFrequently: true});
      context.drawImage(element, 0, 0);
      return context.getImageData(0, 0, wide, high);
    };
    const [a, b] = [context_of($("picture")), context_of($("other-picture"))];
    const canvas = $("difference"), out = canvas.getContext("2d"), picture = out.createImageData(wide, high);
    let differing = 0, most = 0;
    for (let i = 0; i < wide * high; ++i) {
      let worst = 0;
      for (let c = 0; c < 3; ++c) {
        const apart = Math.abs(a.data[4 * i + c] - b.data[4 * i + c]);
        picture.data[4 * i + c] = Math.min(255, 4 * apart);
        worst = Math.max(worst, apart);
      }
      picture.data[4 * i + 3] = 255;
      differing += worst > 0;
      most = Math.max(most, worst);
    }
    out.putImageData(picture, 0, 0);
    $("difference-words").textContent = differing === 0 ? "no pixel differs"
        : `${short(differing)} of ${short(wide * high)} pixels differ, by up to ${most} of 255; shown four times as large`;
    tell(canvas, wide, high, (x, y) => {
      const at = 4 * (y * wide + x), rgb = d => `${d.data[at]}, ${d.data[at + 1]}, ${d.data[at + 2]}`;
      return `(${x}, ${y}): ${rgb(a)} and ${rgb(b)}`;
    });
  }

  // ---- the view in the address, so that it can be passed on

  let film = null, ready = false;
  function remember() {
    if (!ready) return;
    const parts = [];
    if (film) parts.push(`frame=${film.at}`);
    if (chosen) parts.push(`pixel=${chosen}`);
    history.replaceState(null, "", "#" + parts.join("&"));
  }
  const wanted = new URLSearchParams(location.hash.slice(1));

  const whole = image => image.decode().catch(() => {});
  if (data.film) {
    $("film").hidden = false;
    film = new Film(data.film);
    film.show(wanted.has("frame") ? Number(wanted.get("frame")) || 0 : film.busiest);
  }
  if (data.rays) {
    $("rays").hidden = false;
    data.rays.parent.forEach((parent, row) => {
      if (parent >= 0) put(children, parent, row); else put(roots, data.rays.pixel[row], row);
    });
    for (const element of document.querySelectorAll("#picture, img[data-map]")) {
      element.style.cursor = "pointer";
      element.addEventListener("click", event => choose_under(event, element));
    }
    for (const id of ["ray-x", "ray-y"]) {
      $(id).addEventListener("change", () => choose(clamp(Number($("ray-x").value), 0, wide - 1),
                                                    clamp(Number($("ray-y").value), 0, high - 1)));
    }
    if (wanted.has("pixel")) choose(...wanted.get("pixel").split(",").map(Number));
  }
  if ($("difference")) {
    await Promise.all([whole($("picture")), whole($("other-picture"))]);
    difference();
  }
  ready = true;
  document.body.dataset.ready = "yes";
})();
