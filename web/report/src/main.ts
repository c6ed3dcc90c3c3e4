// Reads the record and puts the page together, the answer first.
import { Clock } from './clock';
import { button, element } from './elements';
import { drawCauses, leadsTo, type Go } from './causes';
import { drawFrames } from './frames';
import { drawPlots } from './plots';
import { findingsInTime, drawReplay } from './replay';
import { calibrationTable, drawCalibrationNotRun, drawDeviation, drawFigures, drawPictures, drawProvenance, drawStrands } from './tables';
import { drawVerdict } from './verdict';
import { follow } from './live';
import { readRecord, type Report } from './record';
import { Run } from './run';
import type { Stage } from './stage';

function themeSwitch(): HTMLElement {
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const set = (theme: string) => {
    document.documentElement.dataset.theme = theme;
    node.textContent = theme === 'dark' ? 'Light' : 'Dark';
    node.setAttribute('aria-label', 'Switch to the ' + (theme === 'dark' ? 'light' : 'dark') + ' colours');
    document.dispatchEvent(new Event('understudy-theme'));
  };
  const node = button('', () => set(document.documentElement.dataset.theme === 'dark' ? 'light' : 'dark'), { class: 'theme' });
  dark.addEventListener('change', () => set(dark.matches ? 'dark' : 'light'));
  set(dark.matches ? 'dark' : 'light');
  return node;
}

/** The replay, or why there is none; a damaged part leaves the rest of the page whole. */
function replayOf(report: Report): { clock: Clock; node: HTMLElement; stage: Stage | null } | string | null {
  if (!report.replay) return report.trace ? 'The replay is left out: this record was written without it.' : null;
  try {
    const run = new Run(report.replay);
    if (!(run.time.length > 0) || !isFinite(run.end)) return 'The replay is left out: its path has no instants.';
    const clock = new Clock(run.start, run.end);
    const { node, stage } = drawReplay(report, report.replay, run, clock);
    // At the worst cause; of a run without findings, at its end.
    const first = [...(report.summary.finding_groups || []).map((group) => group.worst), ...findingsInTime(report, run)].find((f) => leadsTo(f, clock));
    clock.seek(first ? first.time_s : run.end);
    stage?.look('all');
    return { clock, node, stage };
  } catch (error) {
    console.warn(error);
    return 'The replay is left out: its part of the record cannot be read (' + (error instanceof Error ? error.message : String(error)) + ').';
  }
}

function keys(clock: Clock, page: HTMLElement) {
  document.addEventListener('keydown', (event) => {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA|BUTTON|SUMMARY)$/.test(target.tagName) && event.key === ' ') return;
    if (event.key === ' ' && !target.closest('dialog')) { event.preventDefault(); clock.toggle(); }
    if (event.key === 'n') (page.querySelector('.next-finding') as HTMLElement | null)?.click();
  });
}

function draw(report: Report, page: HTMLElement) {
  const add = (part: Node | null) => { if (part) page.append(part); };
  const theme = themeSwitch();
  add(drawVerdict(report, theme));
  const replay = replayOf(report);
  const live = replay !== null && typeof replay !== 'string' ? replay : null;
  const go: Go = (finding) => {
    if (!live) return;
    if (live.clock.playing) live.clock.toggle();
    live.clock.seek(finding.time_s);
    live.stage?.look('tool');
    live.node.scrollIntoView({ behavior: 'auto', block: 'nearest' });
    live.node.querySelector<HTMLElement>('.scrub')?.focus({ preventScroll: true });
  };
  const causes = drawCauses(report, live && live.clock, go);
  add(element('div', { class: live ? 'desk' : 'desk alone' }, causes, live ? live.node : null));
  if (typeof replay === 'string') add(element('p', { class: 'warn-note' }, replay));
  if (live) {
    keys(live.clock, page);
    if (live.stage) document.addEventListener('understudy-theme', () => live.stage!.setTheme());
  }
  add(drawCalibrationNotRun(report));
  add(drawPlots(report, live && live.clock, () => (report.summary.calibration ? calibrationTable(report.summary.calibration) : null)));
  add(drawDeviation(report));
  add(drawFrames(report));
  add(drawPictures(report, !live || !live.stage));
  add(drawStrands(report));
  add(drawFigures(report));
  add(drawProvenance(report));
}

const page = document.getElementById('page')!;
try {
  const report = readRecord();
  if (report.live) follow(report, page, themeSwitch());
  else draw(report, page);
} catch (error) {
  page.replaceChildren(element('h1', {}, document.title), element('p', { class: 'warn-note' },
    (error instanceof Error ? error.message : String(error)) + ' The same figures stand in summary.json and trace.csv beside this page.'));
}
page.dataset.ready = 'true';
window.addEventListener('beforeprint', () => {
  for (const details of document.querySelectorAll('details')) details.open = true;
});
