/** A change to uPlot that its next release brings, for every build of ours. */
import type { Plugin } from "rolldown";

const MADE = "new Intl.NumberFormat(domEnv ? nav.language : 'en-US')";

/**
 * uPlot 1.6.32 makes a number format of the browser's language when it is imported. That throws where the language is no BCP 47
 * tag, such as "C" or "en-US@posix". Its authors have since left the language out (leeoniya/uPlot#1054). The chart has its own
 * formats and never uses this one.
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
