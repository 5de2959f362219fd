// Slots: 0 what a body's cells displace (kg/m2), 1 the same as depth (m), 2 the factors s along its contour.
#define SUM_PEAKS push_peaks
#define SUM_COUNTS push_counts
#define SUM_WORDS push_sums
