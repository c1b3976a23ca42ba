// One level of a mip chain: one thread per word of it, or per texel if that is larger.
#include "shared/mip_chain.glsl"

layout(local_size_x_id = 0, local_size_y_id = 1, local_size_z = 1) in;

void main() {
    make_texels(gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x);
}
