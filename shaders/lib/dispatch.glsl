// Which work item this invocation is, when Stream::dispatch was given a plain thread count: more groups than fit into one
// dimension are folded into y and z.
#ifndef EXEMPLAR_DISPATCH_GLSL
#define EXEMPLAR_DISPATCH_GLSL

uint linear_group() {
    return (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// At most the thread count plus one row of groups: compare it with the number of items. A macro, because glslang takes
// gl_WorkGroupSize for 1 in a function that stands before the shader's local size.
#define linear_thread() (linear_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

#endif
