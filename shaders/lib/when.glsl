// `when (condition) { ... }` is an `if` that is skipped if no invocation of the subgroup takes it: D3 in
// docs/portability.md. For bodies that few invocations take; break and continue must not leave them.
#ifndef EXEMPLAR_WHEN_GLSL
#define EXEMPLAR_WHEN_GLSL

#define when(condition) for (bool taken = (condition); taken; taken = false)

#endif
