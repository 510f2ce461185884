// Tables that neighboring invocations read at the same places. CPU drivers read them as texels (D4 in
// docs/portability.md). Cards read them from storage buffers, through scalar loads that serve a whole subgroup:
//   layout(set = 0, binding = 1) uvec4_table(Stumps, stumps);
//   const uvec4 stump = table_entry(stumps, i);
#ifndef EXEMPLAR_TABLES_GLSL
#define EXEMPLAR_TABLES_GLSL

#ifdef EXEMPLAR_CPU
#define uvec4_table(Block, name) uniform usamplerBuffer name
#define vec4_table(Block, name) uniform samplerBuffer name
#define table_entry(name, index) texelFetch(name, int(index))
#else
#define uvec4_table(Block, name) readonly buffer Block { uvec4 name[]; }
#define vec4_table(Block, name) readonly buffer Block { vec4 name[]; }
#define table_entry(name, index) name[index]
#endif

#endif
