// The program beside the replay: only the lines in view are in the page, however long it is.
import { element } from './elements';
import { unpackText } from './pack';
import type { Clock } from './clock';
import type { Report, ReplayData } from './record';
import type { Run } from './run';

const kHeight = 20;  // [px] of a line

export function drawProgram(report: Report, data: ReplayData, run: Run, clock: Clock): HTMLElement {
  const lines = unpackText(data.program.text).replace(/\r\n?/g, '\n').split('\n');
  if (lines.length > 1 && lines[lines.length - 1] === '') lines.pop();
  const marks = new Map<number, string>();
  for (const finding of report.summary.findings)
    if (finding.gcode_line && marks.get(finding.gcode_line) !== 'error') marks.set(finding.gcode_line, finding.severity);
  let current = 0;
  const list = element('ol', { class: 'lines' });
  const space = element('div', { class: 'lines-space', style: 'height: ' + kHeight * lines.length + 'px' }, list);
  const box = element('div', { class: 'program', tabindex: 0, role: 'group', 'aria-label': 'Program; arrow keys move the replay line by line' }, space);
  const draw = () => {
    const first = Math.max(0, Math.floor(box.scrollTop / kHeight) - 4);
    const last = Math.min(lines.length, first + Math.ceil((box.clientHeight || 400) / kHeight) + 8);
    list.style.transform = 'translateY(' + first * kHeight + 'px)';
    list.replaceChildren(...lines.slice(first, last).map((text, i) => {
      const number = first + i + 1;
      const classes = [marks.get(number) || '', number === current ? 'now' : ''].join(' ').trim();
      return element('li', { class: classes || null, 'data-line': number, 'aria-current': number === current ? 'true' : null },
        element('span', { class: 'at' }, String(number)), element('code', {}, text.slice(0, 400)));
    }));
  };
  const go = (line: number) => {
    const time = run.timeOfLine(line);
    if (time !== null) clock.seek(time);
  };
  box.addEventListener('scroll', draw);
  list.addEventListener('click', (event) => {
    const row = (event.target as Element).closest('li');
    if (row) go(Number(row.dataset.line));
  });
  box.addEventListener('keydown', (event) => {
    const step = event.key === 'ArrowDown' ? 1 : event.key === 'ArrowUp' ? -1 : 0;
    if (!step) return;
    event.preventDefault();
    for (let line = current + step; line >= 1 && line <= lines.length; line += step) {
      const time = run.timeOfLine(line);
      if (time !== null && run.lineAt(time) === line) { clock.seek(time); return; }
    }
  });
  const reveal = () => {
    const top = (current - 1) * kHeight, height = box.clientHeight || 400;
    if (top < box.scrollTop + kHeight || top > box.scrollTop + height - 2 * kHeight) box.scrollTop = top - height / 2;
    draw();
  };
  clock.onTime((time) => {
    const line = run.lineAt(time);
    if (line === current && list.childElementCount) return;
    current = line;
    reveal();
  });
  new ResizeObserver(reveal).observe(box);
  const left = data.program.left_out_bytes;
  return element('div', { class: 'program-pane' }, element('h3', {}, report.names.program),
    left ? element('p', { class: 'note' }, 'The last ' + Math.round(left / 1000) + ' kB of the program are left out.') : null, box);
}
