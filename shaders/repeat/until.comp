// Ends a repeat. One work group compares all elements; NaN is not below anything, so that a solver which broke runs all its turns.
shared uint too_large;

bool is_below(uint i) {
#if WATCHED_TYPE_FLOAT
  return (floatBitsToUint(watched[i]) & 0x7fffffffu) <= 0x7f800000u && watched[i] < below;
#elif WATCHED_TYPE_INT
  return watched[i] <= largest;
#else
  return largest >= 0 && watched[i] <= uint(largest);
#endif
}

void main() {
  uint own = gl_LocalInvocationID.x;
  if (own == 0u) too_large = 0u;
  barrier();
  bool was_reached = progress[1] != 0u;
  if (!was_reached) {
    bool large = false;
    for (uint i = own; i < uint(elements) && !large; i += gl_WorkGroupSize.x) large = !is_below(i);
    if (large) too_large = 1u;
  }
  barrier();
  bool reached = was_reached || too_large == 0u;
  bool last = progress[0] + 1u >= uint(max_turns);
  barrier();
  if (own == 0u) {
    if (!was_reached) progress[2] += 1u;
    if (last) progress[3] += 1u;
    progress[0] = last ? 0u : progress[0] + 1u;
    progress[1] = last || !reached ? 0u : 1u;
  }
  if (was_reached == reached && !last) return;  // the counts are right
  bool runs = last || !reached;
  uint counts = 3u * uint(slots);
  for (uint i = own; i < counts; i += gl_WorkGroupSize.x) groups[i] = runs ? groups[counts + i] : 0u;
#if HAS_OWN_GROUPS_0
  if (!runs && own < 3u) own_groups_0[own] = 0u;
#endif
#if HAS_OWN_GROUPS_1
  if (!runs && own < 3u) own_groups_1[own] = 0u;
#endif
#if HAS_OWN_GROUPS_2
  if (!runs && own < 3u) own_groups_2[own] = 0u;
#endif
#if HAS_OWN_GROUPS_3
  if (!runs && own < 3u) own_groups_3[own] = 0u;
#endif
}
