// What a device is called, as its browser tells it.

const SYSTEMS = ["iPhone", "iPad", "Android", "Windows", "Mac", "Linux"];
const BROWSERS = ["Edg", "Firefox", "Chrome", "Safari"];

/** What others tell this device by: its system and its browser. */
export function deviceName(agent: string): string {
  const system = SYSTEMS.find((each) => agent.includes(each)) ?? "Device";
  const browser = BROWSERS.find((each) => agent.includes(each));
  return browser === undefined ? system : `${system}, ${browser === "Edg" ? "Edge" : browser}`;
}
