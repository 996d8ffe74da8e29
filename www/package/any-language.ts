/** Applies a fix from uPlot's next release in each of our builds. */
import type { Plugin } from "rolldown";

const MADE = "new Intl.NumberFormat(domEnv ? nav.language : 'en-US')";

/**
 * On import, uPlot 1.6.32 creates a number format for the browser's language. That throws if the language is not a BCP 47 tag, such as "C"
 * or "en-US@posix". Its authors have since dropped the language (leeoniya/uPlot#1054). The chart has its own formats and never uses this
 * one.
 */
export const anyLanguage: Plugin = {
  name: "cusp:any-language",
  transform: {
    filter: { id: /node_modules[\\/]uplot[\\/][^?]*\.js(\?|$)/ },
    handler(code) {
      if (!code.includes(MADE)) this.error("uPlot makes its number format otherwise: is this plugin still needed?");
      return code.replace(MADE, "new Intl.NumberFormat()");
    },
  },
};
