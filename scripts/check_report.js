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

    const result = document.createElement("pre");
    result.id = "layout-check";
    result.dataset.height = String(Math.ceil(root.scrollHeight));
    result.textContent = "\n\n" + (problems.length === 0 ? "nothing wrong" : problems.slice(0, 40).join("\n")) + "\n";
    document.body.append(result);
})();
