// Index of an invocation when Stream::dispatch was given a plain thread count: workgroups that do not fit into x are
// folded into y and z (gpu/runtime/kernels/threads.h).
#ifndef EXEMPLAR_DISPATCH_GLSL
#define EXEMPLAR_DISPATCH_GLSL

uint linear_group() {
    return (gl_WorkGroupID.z * gl_NumWorkGroups.y + gl_WorkGroupID.y) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
}

// Compare it with the number of items, as the last workgroups exceed the thread count. A macro, because glslang
// takes gl_WorkGroupSize as 1 in a function that precedes the shader's local size.
#define linear_thread() (linear_group() * gl_WorkGroupSize.x + gl_LocalInvocationID.x)

#endif
