// How a page enters: the code behind the # of its address becomes a pass, which the browser keeps.
const RETRY_MS = 1000;
const pause = ms => new Promise(done => setTimeout(done, ms));

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
        if (!answer.ok) say((await answer.text()).trim());
      }
      const about = await (await fetch('/about.json')).json();
      if (!about.may_view) say('This browser needs a code: scan the QR code that footing-web shows.');
      return about;
    } catch {
      say('footing-web does not answer; trying again.');
      await pause(RETRY_MS);
    }
  }
}
