static volatile float shared;
float names_other(void) { return shared += 2.0f; }
__attribute__((visibility("hidden"))) int never_used[3] = {1, 2, 3}; /* --gc-sections takes it away */
