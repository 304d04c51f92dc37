// Ends a process cleanly when it is told to end, in the middle of whatever it does.
#pragma once

#define CADREFINE_DRIVER_EXPORT __attribute__((visibility("default")))

extern "C"
{
  /// From now on SIGINT, SIGTERM and SIGHUP, where they are not ignored, end the process at once
  /// with exit status 128 + signal: `line` goes to standard error, and the files that
  /// cadrefineRemoveOnSignal named are removed. (Python's own handlers wait until a filter is
  /// done.)
  CADREFINE_DRIVER_EXPORT void cadrefineEndOnSignal(const char* line);

  /// Adds a file, or a folder that is empty once what was added after it is removed.
  CADREFINE_DRIVER_EXPORT void cadrefineRemoveOnSignal(const char* path);

  /// Takes back all that.
  CADREFINE_DRIVER_EXPORT void cadrefineRemoveNothingOnSignal();
}
