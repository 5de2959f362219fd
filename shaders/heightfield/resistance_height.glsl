// The snow resists at the underside, H - D; where the surface is not bound, at height 0.
#if HAS_GROUND && HAS_DEPTH
#define CONTACT_HEIGHT(i) (ground[i] + depth[i] - overlap[i])
#else
#define CONTACT_HEIGHT(i) 0.0
#endif
