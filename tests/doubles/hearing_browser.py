"""A browser that recognizes speech on its device, as none does that tests run in."""

import json
from collections.abc import Sequence

from playwright.async_api import Page

EAR = """(said) => {
    window.SpeechRecognition = class extends EventTarget {
        static available({ processLocally }) {
            return Promise.resolve(processLocally ? "available" : "unavailable");
        }
        start() {
            if (!this.processLocally) throw new Error("what is said leaves the device");
            const transcript = said.shift();
            const heard = Object.assign(new Event("result"), { results: [[{ transcript }]] });
            if (transcript !== "") this.dispatchEvent(heard);
            this.dispatchEvent(new Event("end"));
        }
        abort() {}
    };
}"""


async def give_ear(page: Page, said: Sequence[str]) -> None:
    """Have a page, once it is loaded anew, hear the next of these each time it listens."""
    await page.add_init_script(f"({EAR})({json.dumps(said)})")
