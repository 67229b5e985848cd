// Talks to the lab's server, one question at a time, and shows what there is to say of it in the page's notice.
"use strict";

const PATIENCE = 400; // milliseconds without an answer, after which the page says that it waits
const READ = 6000; // milliseconds for which a notice stays, however many answers come meanwhile

/** Return a function that asks the server; take(answer) is called with each answer but errors, which are shown. */
export function connect(room, take) {
  const protocol = location.protocol === "https:" ? "wss:" : "ws:";
  const socket = new WebSocket(`${protocol}//${location.host}/${room}/socket`);
  const opened = new Promise((resolve, reject) => {
    socket.addEventListener("open", resolve);
    socket.addEventListener("error", () => reject(new Error("The lab does not answer.")));
  });
  let waiting = null; // { resolve, reject } of the question that was asked
  socket.addEventListener("message", (event) => waiting.resolve(JSON.parse(event.data)));
  socket.addEventListener("close", (event) => {
    const words = event.reason || "The lab has ended.";
    waiting?.reject(new Error(words));
    notify(`${words} Start it again with bounce-env lab, and open the address that it prints.`, "error");
  });

  async function exchange(message) {
    await opened;
    const timer = setTimeout(() => notify("Compiling the engine for this: up to a minute, once on each machine …", "busy"), PATIENCE);
    try {
      return await new Promise((resolve, reject) => {
        waiting = { resolve, reject };
        socket.send(JSON.stringify(message));
      });
    } finally {
      clearTimeout(timer);
    }
  }

  let queue = Promise.resolve();
  return (message) => {
    queue = queue.then(() => exchange(message)).then((answer) => {
      if (answer.error) return notify(answer.error, "error");
      if (answer.notice) notify(answer.notice, "good");
      else forget();
      return take(answer);
    }).catch((error) => notify(error.message, "error"));
    return queue;
  };
}

let said = 0; // when the notice was shown [ms]

function notify(text, kind) {
  Object.assign(document.getElementById("notice"), { textContent: text, className: kind });
  said = performance.now();
}

/** Take back a notice that has been read: of waiting at once. */
function forget() {
  const notice = document.getElementById("notice");
  if (notice.className === "busy" || performance.now() - said > READ) Object.assign(notice, { textContent: "", className: "" });
}
