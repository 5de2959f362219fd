// Comparisons with NaN are false, so this holds only for finite numbers; isnan() may be optimised away.
bool is_finite(vec3 v) { return all(lessThan(abs(v), vec3(3.0e38))); }
