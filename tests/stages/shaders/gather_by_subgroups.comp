// The form for subgroups where there are none: the whole group stands for one.
#undef FORM_SUBGROUP
#define FORM_SUBGROUP 1
#include "mpm/gather_block_sums.comp"
