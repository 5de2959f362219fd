// Vectors turned by a quaternion (x, y, z, w).

vec3 turned(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }
vec3 turned_back(vec4 q, vec3 v) { return turned(vec4(-q.xyz, q.w), v); }
