// Ends a process cleanly when it is told to end, in the middle of whatever it does.
#pragma once

#define CADREFINE_DRIVER_EXPORT __attribute__((visibility("default")))

extern "C"
{
  /// From now on SIGINT, SIGTERM and SIGHUP, where they are not ignored, end the process at once
  /// with exit status 128 + signal. (Python's own handlers wait until a filter is done.) What it
  /// does before that:
  /// 1. It carries out `actions`, pairs of paths up to nullptr: "from", "to" renames, "from", ""
  ///    removes, "", "to" makes a folder. It stops at a rename that fails. Where that is the very
  ///    first action, another process has carried it out, which does all that follows.
  /// 2. It removes `unfinished`, files and empty folders up to nullptr, unless it stopped later.
  /// 3. It writes `line` to standard error, `failure` if it stopped later, nothing if at once.
  /// Each call replaces the one before it, in one moment.
  CADREFINE_DRIVER_EXPORT void cadrefineEndOnSignal(const char* line, const char* failure,
    const char* const* actions, const char* const* unfinished);
}
