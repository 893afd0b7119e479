// Part of every program of a sanitizer build. Leaks are not looked for: Open MPI leaves its own behind in components that
// it has unloaded by then, so that no suppression can name them. Uses after return are not looked for: the frames of GCC 12 for
// them are not aligned to the 64 bytes of a vector of lanes, and its aligned moves then fault.
extern "C" const char* __asan_default_options();
extern "C" const char* __asan_default_options() { return "detect_leaks=0:detect_stack_use_after_return=0"; }
extern "C" const char* __ubsan_default_options();
extern "C" const char* __ubsan_default_options() { return "print_stacktrace=1"; }
