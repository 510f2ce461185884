// if (condition) { ... }, which is jumped over where no invocation of a subgroup takes it: CPU drivers run the body of an if
// masked, but leave loops. For bodies that few take; neither break nor continue may leave it.
#ifndef EXEMPLAR_WHEN_GLSL
#define EXEMPLAR_WHEN_GLSL

#define when(condition) for (bool taken = (condition); taken; taken = false)

#endif
