// Looks at the laid-out page and writes what is wrong with it into an element at its end. Run by scripts/check-report.
"use strict";
(function () {
    const problems = [];
    const slack = 1.5; // pixels; glyphs are placed on fractions of pixels
    const boxOf = (element) => element.getBoundingClientRect();
    const overlap = (a, b) =>
        Math.min(a.right, b.right) - Math.max(a.left, b.left) > slack &&
        Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > slack;

    const root = document.documentElement;
    if (root.scrollWidth > root.clientWidth + slack) {
        problems.push(`the page is ${root.scrollWidth} pixels wide in a window of ${root.clientWidth}`);
    }
    const resources = performance.getEntriesByType("resource").map((entry) => entry.name);
    resources.forEach((name) => problems.push(`the page asks for ${name}`));

    const svgs = [...document.querySelectorAll("svg")];
    if (svgs.length === 0) {
        problems.push("the page has no figure");
    }
    svgs.forEach((svg, number) => {
        const picture = boxOf(svg);
        const name = svg.closest("figure")?.getAttribute("aria-label") ?? `figure ${number}`;
        if (picture.width < 200 || picture.height < 100) {
            problems.push(`${name} is only ${picture.width} x ${picture.height} pixels`);
        }
        const texts = [...svg.querySelectorAll("text")].map((t) => ({ words: t.textContent.trim(), box: boxOf(t) }));
        texts.forEach((text, i) => {
            const box = text.box;
            const inside =
                box.left >= picture.left - slack && box.right <= picture.right + slack &&
                box.top >= picture.top - slack && box.bottom <= picture.bottom + slack;
            if (!inside) {
                problems.push(`${name}: "${text.words}" leaves the figure`);
            }
            texts.slice(i + 1).filter((other) => overlap(box, other.box)).forEach((other) => {
                problems.push(`${name}: "${text.words}" lies on "${other.words}"`);
            });
        });
    });

    const blocks = [...document.querySelectorAll("h1, h2, p, table, figure, ul, pre")];
    blocks.forEach((block, i) => {
        blocks.slice(i + 1).filter((other) => !block.contains(other) && overlap(boxOf(block), boxOf(other)))
            .forEach((other) => problems.push(`<${block.tagName}> lies on <${other.tagName}>: ${other.textContent.slice(0, 40)}`));
    });

    // Figures answer to the pointer: a point of a curve is read, the same after a zoom, and all comes back.
    const fire = (target, type, x, y) => target.dispatchEvent(
        new PointerEvent(type, { clientX: x, clientY: y, bubbles: true, pointerType: "mouse", button: 0 }));
    const numbers = (text) => (text.match(/-?\d[\d.]*(e[-+]?\d+)?/g) ?? []).map(Number);
    let answered = 0, withCurves = 0;
    svgs.forEach((svg) => {
        const figure = svg.closest("figure");
        const name = figure?.getAttribute("aria-label") ?? "a figure";
        const note = figure?.querySelector(".value");
        const polylines = [...svg.querySelectorAll("polyline")].filter((e) => e.getAttribute("points").length > 60);
        if (!note || polylines.length === 0) {
            return;
        }
        const scale = () => boxOf(svg).width / svg.viewBox.baseVal.width;
        const curve = polylines[Math.floor(polylines.length / 2)];
        const places = () => curve.getAttribute("points").trim().split(/\s+/).map((p) => p.split(",").map(Number));
        const before = places();
        const index = Math.floor(before.length / 2);
        const onPage = (p) => [boxOf(svg).left + p[0] * scale(), boxOf(svg).top + p[1] * scale()];
        const read = (place) => {
            fire(svg, "pointermove", ...onPage(places()[place]));
            return note.hidden ? [] : numbers(note.textContent).slice(-2);
        };
        const [first, other] = [read(index), read(0)];
        withCurves += 1;
        if (first.length !== 2) {
            problems.push(`${name}: a point of its curve is not read: "${note.textContent}"`);
            return;
        }
        const [x, y] = onPage(before[index]);
        fire(svg, "pointerdown", x - 40, y);
        fire(svg, "pointermove", x + 55, y);
        fire(window, "pointerup", x + 55, y);
        const second = read(index);
        const close = (i) => Math.abs(second[i] - first[i]) <= 0.02 * Math.max(Math.abs(first[i]), Math.abs(first[i] - other[i]));
        // Over a surface another outline may be nearer.
        const isSurface = svg.querySelectorAll("rect").length > 100;
        const isSame = second.length === 2 && (isSurface || (close(0) && close(1)));
        if (!isSame) {
            problems.push(`${name}: reads ${first} in the whole and ${second} in a part`);
        }
        if (places().every((p, i) => p[0] === before[i][0] && p[1] === before[i][1])) {
            problems.push(`${name}: does not zoom`);
        }
        fire(svg, "pointermove", 0, 0);
        svg.dispatchEvent(new MouseEvent("dblclick", { bubbles: true }));
        if (places().some((p, i) => Math.hypot(p[0] - before[i][0], p[1] - before[i][1]) > 0.2)) {
            problems.push(`${name}: does not come back after a zoom`);
        }
        fire(svg, "pointerleave", 0, 0);
        answered += 1;
    });
    if (answered === 0 && withCurves > 0) {
        problems.push("no figure answers to the pointer");
    }

    const result = document.createElement("pre");
    result.id = "layout-check";
    result.dataset.height = String(Math.ceil(root.scrollHeight));
    result.textContent = "\n\n" + (problems.length === 0 ? "nothing wrong" : problems.slice(0, 40).join("\n")) + "\n";
    document.body.append(result);
    if (window.parent !== window) {
        window.parent.postMessage({ text: result.textContent, height: result.dataset.height }, "*");
    }
})();
