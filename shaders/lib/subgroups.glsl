// The number of this invocation such that those of one subgroup follow one another, and waiting for one's own subgroup. FIRN_SUBGROUPS: the device
// has them (GL_KHR_shader_subgroup_basic); else the whole group stands for one.
#if FIRN_SUBGROUPS
uint invocation_by_subgroup() { return gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID; }
#define WAIT_FOR_SUBGROUP subgroupBarrier();
#else
uint invocation_by_subgroup() { return gl_LocalInvocationID.x; }
#define WAIT_FOR_SUBGROUP barrier();
#endif
