// Part of every program of a sanitizer build. Leaks are not looked for: Open MPI leaves its own behind in components that
// it has unloaded by then, so that no suppression can name them.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0:detect_stack_use_after_return=1"; }
extern "C" const char* __ubsan_default_options();
extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1"; }
