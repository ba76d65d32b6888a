// A session with footingd or footing-sim through footing-web (docs/web.md): connects, keeps
// connected, subscribes, answers pings and estimates the server's clock.
import { whyClosed } from './entry.js';
import { decode, encode } from './protobuf.js';

const SHORTEST_WAIT_MS = 250, LONGEST_WAIT_MS = 4000;
const PING_EVERY_MS = 1000, SILENT_AFTER_MS = 3000, DEAD_AFTER_MS = 10000;
const LATEST = 1, VIEW = 1;
const KEPT_PINGS = 8;  // The offset is that of the fastest of the last ones.

const nowNs = () => performance.now() * 1e6;

// States: 'connecting', 'live', 'silent' (nothing for 3 s), 'refused'.
export class Session {
  // options: path, name, channels, maxHz. handlers: onWelcome(welcome), onTick(tick),
  // onGap(count), onState(state, why).
  constructor(options, handlers) {
    this.options = options;
    this.handlers = handlers;
    this.wait = SHORTEST_WAIT_MS;
    this.state = '';
    this.pings = [];
    this.heard = 0;
    this.connect();
    this.watching = setInterval(() => this.watch(), PING_EVERY_MS);
  }

  end() {
    clearInterval(this.watching);
    const { socket } = this;
    this.socket = null;
    socket.close();
  }

  connect() {
    this.set('connecting', this.why ?? '');
    this.why = '';
    const scheme = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(`${scheme}//${location.host}${this.options.path}`);
    socket.binaryType = 'arraybuffer';
    this.socket = socket;
    this.last = null;
    socket.onopen = () => {
      this.heard = performance.now();
      this.send({ hello: { protocol_major: 1, role: VIEW, client_name: this.options.name } });
      this.subscribe();
    };
    socket.onmessage = event => this.take(new Uint8Array(event.data));
    socket.onclose = async event => {
      const why = event.reason || this.why || await whyClosed('may_view');
      if (this.socket !== socket) return;
      this.why = why;
      if (this.state !== 'refused') this.set('connecting', this.why);
      setTimeout(() => { if (this.socket === socket) this.connect(); }, this.wait * (0.5 + 0.5 * Math.random()));
      this.wait = Math.min(2 * this.wait, LONGEST_WAIT_MS);
    };
  }

  // Begins with a snapshot of what the server retains.
  subscribe() {
    const { channels, maxHz } = this.options;
    this.send({ subscribe: { channels, max_hz: maxHz, policy: LATEST } });
  }

  send(envelope) {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(encode('Envelope', envelope));
  }

  set(state, why) {
    if (state === this.state && why === this.shownWhy) return;
    this.state = state;
    this.shownWhy = why;
    this.handlers.onState(state, why);
  }

  take(bytes) {
    const arrived = nowNs();
    this.heard = performance.now();
    let message;
    try {
      message = decode('Envelope', bytes);
    } catch (error) {
      this.why = `a message cannot be read (${error.message}); load the page again`;
      return this.socket?.close();
    }
    if (message.ping) {
      const { id, t0_ns } = message.ping;
      this.send({ pong: { id, t0_ns, t1_ns: arrived, t2_ns: nowNs() } });
    } else if (message.pong) {
      this.takePong(message.pong, arrived);
    } else if (message.welcome) {
      this.wait = SHORTEST_WAIT_MS;
      this.why = '';
      this.pings = [];
      this.handlers.onWelcome(message.welcome);
      this.set('live', '');
      this.ping();
    } else if (message.refused) {
      this.why = message.refused.message;
      this.set('refused', this.why);
    } else if (message.goodbye) {
      this.why = message.goodbye.reason;
    } else if (message.gap) {
      const missing = message.gap.to_sequence - message.gap.from_sequence + 1n;
      this.handlers.onGap(Number(missing));
    } else if (message.tick) {
      this.set('live', '');
      this.handlers.onTick(message.tick);
    }
  }

  ping() {
    this.send({ ping: { id: 1n, t0_ns: nowNs() } });
  }

  takePong(pong, arrived) {
    const roundTrip = arrived - pong.t0_ns - (pong.t2_ns - pong.t1_ns);
    const offset = (pong.t1_ns - pong.t0_ns + (pong.t2_ns - arrived)) / 2;
    this.pings.push({ roundTrip, offset });
    if (this.pings.length > KEPT_PINGS) this.pings.shift();
  }

  // The server's clock now, ns; NaN before the first answer.
  serverNs() {
    let best = { roundTrip: Infinity, offset: NaN };
    for (const one of this.pings) if (one.roundTrip < best.roundTrip) best = one;
    return nowNs() + best.offset;
  }

  watch() {
    if (this.socket.readyState !== WebSocket.OPEN) return;
    this.ping();
    const silentMs = performance.now() - this.heard;
    if (silentMs > DEAD_AFTER_MS) {
      this.why = 'the connection is dead';
      this.socket.close();
    } else if (silentMs > SILENT_AFTER_MS) {
      this.set('silent', `nothing for ${Math.round(silentMs / 1000)} s`);
    }
  }
}
