import { expect, test } from "vitest";
import { addressOf, settingsOf } from "./address.js";

test("settings and the page's own keys share an address", () => {
  const address = new URLSearchParams("height=60&locale=de&backend=cpu");
  expect(settingsOf(address)).toBe("height=60");
  expect(addressOf("height=60", new URLSearchParams("locale=de"))).toBe("?height=60&locale=de");
  expect(addressOf("", new URLSearchParams())).toBe("");
});
