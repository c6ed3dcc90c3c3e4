// The instant that replay, program, plots and frames all show.
export class Clock {
  time: number;
  playing = false;
  rate = 1;
  private listeners: ((time: number) => void)[] = [];
  private states: (() => void)[] = [];
  private last = 0;

  constructor(readonly start: number, readonly end: number) { this.time = end; }

  onTime(listener: (time: number) => void) { this.listeners.push(listener); listener(this.time); }
  onState(listener: () => void) { this.states.push(listener); listener(); }

  seek(time: number) {
    this.time = Math.min(this.end, Math.max(this.start, time));
    for (const listener of this.listeners) listener(this.time);
  }

  setRate(rate: number) { this.rate = rate; this.tellState(); }

  toggle() {
    this.playing = !this.playing;
    if (this.playing && this.time >= this.end) this.seek(this.start);
    this.tellState();
    if (this.playing) { this.last = performance.now(); requestAnimationFrame(this.step); }
  }

  private tellState() { for (const state of this.states) state(); }

  private step = (now: number) => {
    if (!this.playing) return;
    const passed = Math.max(0, now - this.last) / 1000;
    this.last = now;
    this.seek(this.time + passed * this.rate);
    if (this.time >= this.end) { this.playing = false; this.tellState(); return; }
    requestAnimationFrame(this.step);
  };
}
