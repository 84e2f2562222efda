// Values under the pointer, and zoom, for the figures of the page. Axes are read from their ticks, curves from what is
// drawn: no number stands in the page twice, and nothing is loaded. Values are as exact as the drawing: a tenth of a
// pixel.
"use strict";
(function () {
    const NEAR = 30; // pixels from the pointer to a point that it shows
    const DRAG = 8; // pixels from which on a movement is a zoom
    const SLACK = 6; // units of a drawing; ten are a pixel
    const MARK = 250; // units; a smaller polygon is a mark

    const attribute = (element, name) => Number(element.getAttribute(name));
    const pointsOf = (element) =>
        element.getAttribute("points").trim().split(/\s+/).map((pair) => pair.split(",").map(Number));
    const colourOf = (element) => {
        const stroke = element.getAttribute("stroke");
        return stroke && stroke !== "none" ? stroke : element.getAttribute("fill");
    };
    function make(parent, name, attributes) {
        const element = document.createElementNS("http://www.w3.org/2000/svg", name);
        Object.entries(attributes).forEach(([key, value]) => element.setAttribute(key, value));
        parent.append(element);
        return element;
    }

    // An axis from its ticks: [place, value] each. Logarithmic where logarithms lie on a line better than values.
    function axisOf(ticks, hasMinorLines) {
        if (ticks.length < 2) return null;
        const fit = (change) => {
            const [p, q] = [ticks[0], ticks[ticks.length - 1]];
            const slope = (change(q[1]) - change(p[1])) / (q[0] - p[0]);
            const at = (place) => change(p[1]) + slope * (place - p[0]);
            const miss = Math.max(...ticks.map(([place, value]) => Math.abs((change(value) - at(place)) / slope)));
            return { at, slope, start: p[0], first: change(p[1]), miss };
        };
        const linear = fit((value) => value);
        const positive = ticks.every(([, value]) => value > 0);
        const logarithmic = positive ? fit(Math.log10) : null;
        const isLog = logarithmic && (ticks.length > 2 ? logarithmic.miss < linear.miss : hasMinorLines);
        const line = isLog ? logarithmic : linear;
        return {
            isLog,
            value: (place) => (isLog ? 10 ** line.at(place) : line.at(place)),
            place: (value) => line.start + ((isLog ? Math.log10(value) : value) - line.first) / line.slope,
        };
    }

    function digits(axis, value, resolution) {
        if (axis.isLog) return value.toPrecision(3);
        const decimals = Math.min(12, Math.max(0, Math.ceil(-Math.log10(resolution))));
        const size = Math.max(Math.abs(value), resolution);
        const text = size >= 1e6 || size < 1e-4 ? value.toExponential(3) : value.toFixed(decimals);
        return text.replace(/^-(0(\.0*)?)$/, "$1");
    }

    // What is in a drawing: area of the axes, ticks, names, legend, curves.
    function read(svg) {
        const elements = [...svg.children];
        const black = elements.filter((e) => e.tagName === "polyline" && e.getAttribute("stroke") === "#000000");
        const upright = black.map(pointsOf).find((p) => p.length === 2 && p[0][0] === p[1][0]);
        const level = black.map(pointsOf).find((p) => p.length === 2 && p[0][1] === p[1][1] && p[1][0] - p[0][0] > 300);
        if (!upright || !level) return null;
        const area = { left: level[0][0], right: level[1][0], top: upright[0][1], bottom: upright[1][1] };
        const inside = (x, y) =>
            x >= area.left - SLACK && x <= area.right + SLACK && y >= area.top - SLACK && y <= area.bottom + SLACK;
        const texts = elements.filter((e) => e.tagName === "text");
        const place = (e) => [attribute(e, "x"), attribute(e, "y")];
        const words = (e) => e.textContent.trim();
        const value = (e) => Number(words(e).replace("\u2212", "-"));
        const isCentred = (e) => !e.hasAttribute("transform") && e.getAttribute("text-anchor") === "middle";
        const isUpright = (e) => e.hasAttribute("transform");
        const labels = {
            x: texts.filter((e) => e.getAttribute("dy") === "0.76em"),
            y: texts.filter((e) => e.getAttribute("text-anchor") === "end" && place(e)[0] < area.left),
            bar: texts.filter((e) => e.getAttribute("text-anchor") === "start" && place(e)[0] > area.right),
        };
        const minor = elements.some((e) => e.tagName === "line" && e.getAttribute("stroke") === "#E8E8E8");
        const ticks = (which, i) =>
            labels[which].map((e) => [place(e)[i], value(e)]).filter(([, number]) => Number.isFinite(number));
        const names = {
            x: texts.filter((e) => isCentred(e) && place(e)[1] > area.bottom && !labels.x.includes(e)).map(words)[0],
            y: texts.filter((e) => isUpright(e) && place(e)[0] < area.left).map(words)[0],
            bar: texts.filter((e) => isUpright(e) && place(e)[0] > area.right).map(words)[0],
        };
        const x = axisOf(ticks("x", 0), minor), y = axisOf(ticks("y", 1), minor);
        if (!x || !y) return null;
        const legend = new Map();
        elements.forEach((e, i) => {
            const text = elements.slice(i + 1).find((other) => other.tagName === "text");
            const above = ["polyline", "polygon"].includes(e.tagName) && pointsOf(e).every((p) => p[1] < area.top);
            const round = e.tagName === "circle" && attribute(e, "cy") < area.top;
            if ((above || round) && text && text.getAttribute("text-anchor") === "start") {
                legend.set(colourOf(e), words(text));
            }
        });
        const isTick = (e) => e.tagName === "line" || labels.x.includes(e) || labels.y.includes(e) ||
            (black.includes(e) && pointsOf(e).length === 2 && !pointsOf(e).every(([a, b]) => inside(a, b)) &&
                pointsOf(e).some(([a, b]) => Math.abs(a - area.left) <= SLACK || Math.abs(b - area.bottom) <= SLACK));
        const frame = elements.filter(isTick);
        const axes = [...black.slice(0, 200)].filter((e) => {
            const p = pointsOf(e);
            return p.length === 2 && [upright, level].some((own) => String(own) === String(p));
        });
        const drawn = elements.filter((e) => !frame.includes(e) && !axes.includes(e)).map(shapeOf);
        const shapes = drawn.filter((shape) => shape && shape.places.every(([a, b]) => inside(a, b)));
        const bar = drawn.filter((shape) => shape && shape.kind === "cell" && shape.places[0][0] > area.right);
        const barAxis = axisOf(ticks("bar", 1), false);
        return { area, x, y, names, legend, frame, shapes, labels, bar, barAxis, inside };
    }

    // A part of a curve or surface, with its places as they were drawn.
    function shapeOf(element) {
        const at = (...names) => names.map((name) => attribute(element, name));
        switch (element.tagName) {
            case "polyline":
            case "polygon": {
                const places = pointsOf(element);
                const extent = (i) => Math.max(...places.map((p) => p[i])) - Math.min(...places.map((p) => p[i]));
                const isMark = element.tagName === "polygon" && extent(0) < MARK && extent(1) < MARK;
                return { element, places, kind: isMark ? "mark" : element.tagName === "polygon" ? "area" : "line" };
            }
            case "circle":
                return { element, places: [at("cx", "cy")], kind: "circle" };
            case "rect": {
                const [x, y, width, height] = at("x", "y", "width", "height");
                return { element, places: [[x, y], [x + width, y + height]], kind: "cell" };
            }
            case "text":
                return { element, places: [at("x", "y")], kind: "text" };
            default:
                return null;
        }
    }

    const middle = (places) => [0, 1].map((i) => places.reduce((sum, p) => sum + p[i], 0) / places.length);

    function move(shape, map) {
        const { element, places, kind } = shape;
        const set = (values) => Object.entries(values).forEach(([key, value]) => element.setAttribute(key, value));
        const write = (all) => set({ points: all.map((p) => p.map((v) => v.toFixed(1)).join(",")).join(" ") });
        if (kind === "line" || kind === "area") write(places.map(map));
        if (kind === "mark") {
            const old = middle(places), now = map(old);
            write(places.map((p) => [p[0] + now[0] - old[0], p[1] + now[1] - old[1]]));
        }
        if (kind === "circle") set({ cx: map(places[0])[0], cy: map(places[0])[1] });
        if (kind === "text") set({ x: map(places[0])[0], y: map(places[0])[1] });
        if (kind === "cell") {
            const [a, b] = places.map(map);
            set({ x: a[0], y: a[1], width: b[0] - a[0], height: b[1] - a[1] });
        }
    }

    // Round values in a range: at multiples of 1, 2 or 5 times a power of ten, or at powers of ten.
    function roundValues(axis, low, high) {
        if (axis.isLog && high / low > 10) {
            const first = Math.ceil(Math.log10(low)), last = Math.floor(Math.log10(high));
            return Array.from({ length: last - first + 1 }, (_, i) => [10 ** (first + i), `1e${first + i}`]);
        }
        const raw = (high - low) / 5, power = 10 ** Math.floor(Math.log10(raw));
        const step = power * [1, 2, 5, 10].find((factor) => factor * power >= raw * (1 - 1e-9));
        const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
        const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
        return Array.from({ length: last - first + 1 }, (_, i) => {
            const value = (first + i) * step;
            const isLarge = Math.abs(value) >= 1e6 || decimals > 8;
            return [value, isLarge ? value.toExponential(2) : value.toFixed(decimals).replace(/^-(0(\.0*)?)$/, "$1")];
        });
    }

    function attend(figure, svg) {
        const drawing = read(svg);
        if (!drawing) return;
        const { area, x, y, names, legend, frame, shapes, labels } = drawing;
        const whole = [area.left, area.top, area.right, area.bottom];
        let shown = whole, layer = null, ticks = null, start = null, box = null;

        const note = document.createElement("div");
        note.className = "value";
        note.hidden = true;
        figure.append(note);
        const ring = { r: 40, fill: "none", stroke: "#000", "stroke-width": 12, visibility: "hidden" };
        const dot = make(svg, "circle", ring);

        const map = ([a, b]) => [
            area.left + ((a - shown[0]) * (area.right - area.left)) / (shown[2] - shown[0]),
            area.top + ((b - shown[1]) * (area.bottom - area.top)) / (shown[3] - shown[1]),
        ];
        const back = ([a, b]) => [
            shown[0] + ((a - area.left) * (shown[2] - shown[0])) / (area.right - area.left),
            shown[1] + ((b - area.top) * (shown[3] - shown[1])) / (area.bottom - area.top),
        ];
        function pointer(event) {
            const own = svg.getBoundingClientRect(), view = svg.viewBox.baseVal;
            const scale = own.width / view.width;
            return { at: [(event.clientX - own.left) / scale, (event.clientY - own.top) / scale], scale };
        }

        function drawTicks() {
            ticks?.remove();
            ticks = null;
            const isWhole = shown.every((value, i) => value === whole[i]);
            frame.forEach((element) => (element.style.display = isWhole ? "" : "none"));
            if (isWhole) return;
            ticks = make(svg, "g", {});
            svg.insertBefore(ticks, svg.children[1]);
            const write = (text, sample, at) => {
                const copy = sample.cloneNode(false);
                copy.textContent = text;
                copy.style.display = "";
                Object.entries(at).forEach(([key, value]) => copy.setAttribute(key, value));
                ticks.append(copy);
            };
            const grid = { stroke: "#CDCDCD", "stroke-width": 6 };
            const line = (x1, y1, x2, y2) => make(ticks, "line", { x1, y1, x2, y2, ...grid });
            roundValues(x, ...[x.value(shown[0]), x.value(shown[2])].sort((a, b) => a - b)).forEach(([value, text]) => {
                const [at] = map([x.place(value), 0]);
                line(at, area.top, at, area.bottom);
                write(text, labels.x[0], { x: at });
            });
            roundValues(y, ...[y.value(shown[3]), y.value(shown[1])].sort((a, b) => a - b)).forEach(([value, text]) => {
                const at = map([0, y.place(value)])[1];
                line(area.left, at, area.right, at);
                write(text, labels.y[0], { y: at });
            });
        }

        // Shows a part of the drawing, in units of the whole one.
        function show(part) {
            shown = part;
            if (!layer) {
                const [left, top] = [area.left, area.top];
                const [width, height] = [area.right - left, area.bottom - top];
                const view = { x: left, y: top, width, height, viewBox: `${left} ${top} ${width} ${height}` };
                layer = make(svg, "svg", view);
                svg.insertBefore(layer, shapes[0].element);
                shapes.forEach((shape) => layer.append(shape.element));
            }
            shapes.forEach((shape) => move(shape, map));
            drawTicks();
            hide();
        }

        function hide() {
            note.hidden = true;
            dot.setAttribute("visibility", "hidden");
        }

        // The drawn point that is nearest to a place, or the cell of a surface under it.
        function find(place, scale) {
            let best = null;
            for (const shape of shapes) {
                const { places, kind } = shape;
                const points = { line: places, circle: places, mark: [middle(places)] }[kind] ?? [];
                for (const point of points) {
                    const [a, b] = map(point);
                    const distance = Math.hypot(a - place[0], b - place[1]) * scale;
                    if (distance < NEAR && (!best || distance < best.distance)) best = { shape, point, distance };
                }
            }
            const isIn = ({ places: [p, q] }, [a, b]) => a >= p[0] && a < q[0] && b >= p[1] && b < q[1];
            const cell = shapes.filter((shape) => shape.kind === "cell" && isIn(shape, back(place))).pop();
            return cell && (!best || best.distance > NEAR / 3) ? { shape: cell, point: back(place) } : best;
        }

        function say(event) {
            const { at, scale } = pointer(event);
            const found = drawing.inside(...at) ? find(at, scale) : null;
            if (!found) return hide();
            const [a, b] = found.point;
            const unit = [0, 1].map((i) => (shown[i + 2] - shown[i]) / (whole[i + 2] - whole[i]));
            const resolution = (axis, place, step) => Math.abs(axis.value(place + step) - axis.value(place));
            const lines = [];
            const colour = colourOf(found.shape.element);
            if (found.shape.kind === "cell") {
                const level = drawing.bar.find((part) => colourOf(part.element) === colour);
                if (level && drawing.barAxis) {
                    const ends = level.places.map((p) => drawing.barAxis.value(p[1])).sort((p, q) => p - q);
                    lines.push(`${names.bar ?? ""}: ${ends.map((end) => end.toPrecision(3)).join(" to ")}`);
                }
            } else if (legend.has(colour)) {
                lines.push(legend.get(colour));
            }
            lines.push(`${names.x ?? "x"}: ${digits(x, x.value(a), resolution(x, a, Math.max(1, 5 * unit[0])))}`);
            lines.push(`${names.y ?? "y"}: ${digits(y, y.value(b), resolution(y, b, Math.max(1, 5 * unit[1])))}`);
            note.textContent = lines.join("\n");
            note.hidden = false;
            const [px, py] = map(found.point);
            dot.setAttribute("cx", px);
            dot.setAttribute("cy", py);
            dot.setAttribute("visibility", found.shape.kind === "cell" ? "hidden" : "visible");
            const left = Math.min(px * scale + 12, figure.clientWidth - note.offsetWidth - 4);
            note.style.left = `${Math.max(0, left)}px`;
            note.style.top = `${Math.max(0, py * scale - note.offsetHeight - 10)}px`;
        }

        svg.addEventListener("pointermove", (event) => {
            if (!start) return say(event);
            const { at } = pointer(event);
            const clamp = (value, low, high) => Math.min(high, Math.max(low, value));
            const end = [clamp(at[0], area.left, area.right), clamp(at[1], area.top, area.bottom)];
            start.end = end;
            box ??= make(svg, "rect", { fill: "#0072B2", "fill-opacity": 0.15, stroke: "#0072B2", "stroke-width": 8 });
            box.setAttribute("x", Math.min(start.at[0], end[0]));
            box.setAttribute("y", Math.min(start.at[1], end[1]));
            box.setAttribute("width", Math.abs(end[0] - start.at[0]));
            box.setAttribute("height", Math.abs(end[1] - start.at[1]));
        });
        svg.addEventListener("pointerdown", (event) => {
            const { at, scale } = pointer(event);
            // A finger scrolls the page; it shows values only.
            if (event.pointerType === "touch" || event.button !== 0 || !drawing.inside(...at)) return say(event);
            event.preventDefault();
            start = { at, scale, end: at };
            hide();
        });
        window.addEventListener("pointerup", () => {
            if (!start) return;
            const { at, end, scale } = start;
            start = null;
            box?.remove();
            box = null;
            const wide = [0, 1].map((i) => Math.abs(end[i] - at[i]) * scale > DRAG);
            if (!wide[0] && !wide[1]) return;
            const [p, q] = [Math.min, Math.max].map((end_of) => back([0, 1].map((i) => end_of(at[i], end[i]))));
            // A movement along one axis zooms that axis.
            show([0, 1, 2, 3].map((i) => (wide[i % 2] ? [...p, ...q][i] : shown[i])));
        });
        svg.addEventListener("pointerleave", hide);
        svg.addEventListener("dblclick", () => show(whole));
    }

    document.querySelectorAll("figure").forEach((figure) => {
        const svg = figure.querySelector("svg");
        if (svg) attend(figure, svg);
    });
})();
