// A run that goes on: the page asks its server for what comes, and for the finished report at the end.
import { drawCauses } from './causes';
import { element } from './elements';
import { drawPlots } from './plots';
import { parseRecord, type Report } from './record';

const kBetweenRecords_ms = 1000;  // each redraws the curves

class LivePage {
  private readonly bar = element('progress', { max: 1, 'aria-label': 'Share of the rehearsal that is done' });
  private readonly note = element('p', { class: 'reason', role: 'status' });
  private readonly title = element('h1');
  private readonly verdict = element('strong', {}, 'running');
  private readonly causes = element('div', { class: 'desk alone' });
  private plots: HTMLElement | null = null;
  private fetched_ms = 0;
  private busy = false;

  constructor(private readonly report: Report, private readonly page: HTMLElement, theme: HTMLElement) {
    page.append(element('header', {}, element('div', { class: 'top' }, element('p', { class: 'eyebrow' }, 'Understudy rehearsal'), theme), this.title,
      element('div', { class: 'verdict running' }, this.verdict, element('div', {}, this.note, this.bar))));
    this.draw();
  }

  tell(live: NonNullable<Report['live']>) {
    this.bar.value = live.share;
    this.note.textContent = (live.note && !live.share ? '' : Math.floor(100 * live.share) + '\u00a0%, ') + live.what + '. '
      + (live.note || 'Replay, pictures and verdict come with the end of the run.');
  }

  async fetch() {
    const now_ms = performance.now();
    if (this.busy || now_ms - this.fetched_ms < kBetweenRecords_ms) return;
    this.busy = true;
    try {
      const answer = await fetch('record.json');
      if (answer.ok) this.take(parseRecord(await answer.text()));
    } finally {
      this.busy = false;
      this.fetched_ms = performance.now();
    }
  }

  end(words: string) {
    this.verdict.textContent = 'done';
    this.stop(words);
  }

  stop(why: string) {
    this.bar.remove();
    this.note.textContent = why;
  }

  private take(fresh: Report) {
    Object.assign(this.report, fresh);
    this.draw();
  }

  private draw() {
    this.title.textContent = this.report.title;
    if (this.report.live) this.tell(this.report.live);
    if (this.report.summary.findings.length) {
      this.causes.replaceChildren(drawCauses(this.report, null, () => undefined));
      this.page.querySelector('header')!.after(this.causes);
    }
    if (!this.report.trace) return;
    if (this.plots) { document.dispatchEvent(new Event('understudy-theme')); return; }  // they read the record anew
    this.plots = drawPlots(this.report, null, () => null);
    if (this.plots) this.page.append(this.plots);
  }
}

export function follow(report: Report, page: HTMLElement, theme: HTMLElement) {
  const live = new LivePage(report, page, theme);
  const events = new EventSource('events');
  events.addEventListener('grown', (event) => {
    live.tell(JSON.parse((event as MessageEvent<string>).data));
    void live.fetch();
  });
  events.addEventListener('done', () => { events.close(); location.reload(); });
  events.addEventListener('ended', (event) => {
    events.close();
    live.end(JSON.parse((event as MessageEvent<string>).data).what);
  });
  const ended = (why: string) => () => { events.close(); live.stop(why); };
  events.addEventListener('stopped', ended('The run was stopped before its end.'));
  events.addEventListener('error', ended('The run cannot be reached any more: it has failed, or was stopped before its end. Its terminal says why.'));
}
