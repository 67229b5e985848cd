// Talks to the lab's server: one question, one answer, in turn.
"use strict";

const PATIENCE = 400; // milliseconds without an answer, after which the page says that it waits

/** Return a function that sends a message and promises its answer. notice(text): shows what there is to say. */
export function connect(room, notice) {
  const protocol = location.protocol === "https:" ? "wss:" : "ws:";
  const socket = new WebSocket(`${protocol}//${location.host}/${room}/socket`);
  const waiting = [];
  let waits = null;
  const opened = new Promise((resolve, reject) => {
    socket.addEventListener("open", resolve);
    socket.addEventListener("error", () => reject(new Error("the lab does not answer")));
  });
  socket.addEventListener("message", (event) => {
    waiting.shift().resolve(JSON.parse(event.data));
    if (waits) [waits] = [clearTimeout(waits)];
  });
  socket.addEventListener("close", (event) => {
    const words = event.reason || "The lab has ended, or this tab was too many.";
    notice(`${words} Start it again with bounce-env lab, and open the address that it prints.`);
    for (const { reject } of waiting.splice(0)) reject(new Error(words));
  });

  return async (message) => {
    await opened;
    if (!waits) {
      waits = setTimeout(() => notice("Compiling the engine for this: up to a minute, once on each machine …", "busy"), PATIENCE);
    }
    const answer = await new Promise((resolve, reject) => {
      waiting.push({ resolve, reject });
      socket.send(JSON.stringify(message));
    });
    return answer;
  };
}
