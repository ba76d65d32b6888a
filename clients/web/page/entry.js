// How a page enters: the code behind the # of its address becomes a pass, which the browser keeps.
const RETRY_MS = 1000;
const pause = ms => new Promise(done => setTimeout(done, ms));

export const sentence = text => text && `${text[0].toUpperCase()}${text.slice(1)}.`;

// The rights of this browser, and how it gets more.
const ask = async () => (await fetch('/about.json')).json();

// Reads what footing-web says about itself and this browser; waits until it answers. `say` gets what is
// wrong, in words.
export async function enter(say) {
  const code = location.hash.slice(1);
  if (code) history.replaceState(null, '', location.pathname + location.search);
  for (let used = !code;;) {
    try {
      if (!used) {
        const answer = await fetch('/enter', { method: 'POST', body: code });
        used = true;
        if (!answer.ok) say(sentence((await answer.text()).trim()));
      }
      const about = await ask();
      if (!about.may_view) say(sentence(about.needs_code));
      return about;
    } catch {
      say('footing-web does not answer; trying again.');
      await pause(RETRY_MS);
    }
  }
}

// Why a WebSocket that needs this right was closed without a reason.
export async function whyClosed(right) {
  try {
    const about = await ask();
    return about[right] ? 'footing-web has closed the connection' : about.needs_code;
  } catch {
    return 'footing-web does not answer';
  }
}
