#!/bin/sh
# Starts the Chromium of CUSP_CHROMIUM without the suggestions of an address bar that nobody sees: they are two pages of their own in
# every window, and take four fifths of the time of opening one. Of several lists of features the last one counts, so these join the others'.
for it do
  shift
  case $it in --disable-features=*) it=$it,WebUIOmniboxPopup,WebUIOmniboxAimPopup ;; esac
  set -- "$@" "$it"
done
exec "$CUSP_CHROMIUM" "$@"
