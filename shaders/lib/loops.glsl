// Loops that CPU drivers do not unroll: D8 in docs/portability.md. The including shader enables
// GL_EXT_control_flow_attributes.
//   keep_loop for (...)    cards unroll it or not, as their compilers choose
//   card_unroll for (...)  cards unroll it, so that arrays indexed in it stay in registers
#ifndef EXEMPLAR_LOOPS_GLSL
#define EXEMPLAR_LOOPS_GLSL

#ifdef EXEMPLAR_CPU
#define keep_loop [[dont_unroll]]
#define card_unroll [[dont_unroll]]
#else
#define keep_loop
#define card_unroll [[unroll]]
#endif

#endif
