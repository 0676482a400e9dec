// Wide and narrow windows: nothing is cut off, nothing lies over what it should not.

import assert from 'node:assert/strict';

/** Fails if the page is wider than its window, or a control is outside of it or too small to be hit. */
export async function layout(tab, width, height) {
  const found = await tab.evaluate(`(() => {
    const box = (element) => {
      const { left, right, top, bottom } = element.getBoundingClientRect();
      return { left, right, top, bottom };
    };
    const of = (id) => box(document.getElementById(id));
    const controls = [...document.querySelectorAll('#panel label')].map((label) => [label.textContent.trim(), box(label)]);
    return {
      page: [document.documentElement.scrollWidth, document.documentElement.scrollHeight],
      panelWidth: document.getElementById('panel').scrollWidth - document.getElementById('panel').clientWidth,
      stage: of('stage'), panel: of('panel'), left: of('left-name'), right: of('right-name'), controls,
    };
  })()`);
  const { page, panelWidth, stage, panel, left, right, controls } = found;
  assert.ok(page[0] <= width && page[1] <= height, `the page is ${page}, the window ${width} x ${height}`);
  assert.ok(panelWidth <= 0, `the panel's content is ${panelWidth} pixels too wide`);
  assert.ok(left.right <= right.left, 'the names of the halves overlap');
  const beside = panel.left >= stage.right;
  const below = panel.top >= stage.bottom;
  assert.ok(beside || below, 'the panel lies over the picture');
  assert.ok(stage.right - stage.left >= 0.6 * width || beside, 'the picture is too narrow');
  assert.ok(stage.bottom - stage.top >= 0.5 * height, 'the picture is too low');
  for (const [text, { left: from, right: to, top, bottom }] of controls) {
    assert.ok(from >= panel.left && to <= panel.right, `${text} is cut off`);
    assert.ok(bottom - top >= 24 && to - from >= 24, `${text} is too small`);
  }
  return `${beside ? 'beside' : 'below'} the picture, ${controls.length} controls`;
}
