// Between a page and its live socket: counts what goes and comes, and holds it back where a test says so.

(() => {
  const Native = globalThis.WebSocket;
  const visit = crypto.randomUUID();
  const open = new Map();
  const watchers = new Set();
  const excused = [];
  let holding = false;
  let silent = false;
  let frozen = false;
  let lateMs = 0;
  let asked = 0;
  let swallowed = null;

  const look = () => watchers.forEach((watch) => watch());
  const until = (reached) => new Promise((done) => {
    const watch = () => {
      if (!reached()) return;
      watchers.delete(watch);
      done();
    };
    watchers.add(watch);
    watch();
  });

  class TappedSocket extends Native {
    #id; #sent = 0; #heard = 0; #over = false; #deaf = silent; #opened = false; #waiting = []; #kept = [];
    onopen = null; onmessage = null; onclose = null;

    constructor(address) {
      const id = `${visit}-${open.size}`;
      const url = new URL(address, location.href);
      url.searchParams.set("tap", id);
      super(url);
      this.#id = id;
      open.set(id, this);
      // The native events reach this class alone: a page sets `onmessage` and its like, which are fields here.
      this.addEventListener("open", (event) => this.#take(() => { this.#opened = true; this.onopen?.(event); }));
      this.addEventListener("message", (event) => { this.#heard += 1; this.#take(() => this.onmessage?.(event)); });
      this.addEventListener("close", (event) => { this.#over = true; this.#take(() => this.onclose?.(event)); });
    }

    get readyState() { return this.#deaf || (frozen && !this.#opened) ? Native.CONNECTING : super.readyState; }
    get bufferedAmount() { return 0; } // What the computer has not yet sent is no matter of the test's time.
    get isUnderWay() { return super.readyState === Native.CONNECTING; }
    get place() { return { id: this.#id, sent: this.#sent, heard: this.#heard, over: this.#over }; }

    send(data) {
      if (silent || (swallowed && data.includes(swallowed))) return;
      if (frozen) this.#kept.push(() => this.#forward(data));
      else if (lateMs) setTimeout(() => this.#forward(data), lateMs);
      else this.#forward(data);
    }

    close(...why) {
      if (frozen) this.#kept.push(() => super.close(...why));
      else super.close(...why);
    }

    thaw() { this.#kept.splice(0).forEach((leave) => leave()); }

    release() { this.#waiting.splice(0).forEach((deliver) => this.#take(deliver)); }

    #forward(data) {
      if (super.readyState !== Native.OPEN) return;
      this.#sent += 1;
      super.send(data);
    }

    #take(deliver) {
      if (holding || frozen) this.#waiting.push(deliver);
      else if (lateMs && !this.#over) setTimeout(deliver, lateMs);
      else if (!silent) deliver();
      look();
    }
  }

  const read = (name) => {
    const native = Response.prototype[name];
    Response.prototype[name] = function (...more) { return counted(native.apply(this, more)); };
  };
  const counted = (promise) => {
    asked += 1;
    const end = () => { asked -= 1; look(); };
    promise.then(end, end);
    return promise;
  };
  const nativeFetch = globalThis.fetch;
  globalThis.fetch = (what, ...more) => {
    const answer = nativeFetch(what, ...more);
    return excused.some((part) => String(what?.url ?? what).includes(part)) ? answer : counted(answer);
  };
  ["text", "json", "arrayBuffer", "blob"].forEach(read);
  globalThis.WebSocket = TappedSocket;

  globalThis.tap = {
    silence(is) { silent = is; },
    // What goes and comes from now on is on its way until it is thawed.
    freeze() { frozen = true; },
    thaw() {
      frozen = false;
      open.forEach((socket) => { socket.thaw(); socket.release(); });
    },
    delay(ms) { lateMs = ms; }, // each way, in whole beats of the stage
    swallow(part) { swallowed = part; }, // what says this does not arrive
    // A request to such an address is not waited for.
    excuse(part) { excused.push(part); },
    places() { return [...open.values()].map((socket) => socket.place).filter((place) => !place.over); },
    // Once all that the panel has told is here, hand it on; then say how much was sent. `hold` what comes next?
    async settle({ told, hold }) {
      for (const socket of silent ? [] : open.values()) {
        await until(() => socket.place.over || (!socket.isUnderWay && socket.place.heard >= (told[socket.place.id] ?? 0)));
      }
      holding = false;
      open.forEach((socket) => socket.release());
      await until(() => asked === 0);
      holding = hold;
      return this.places();
    },
  };
})();
