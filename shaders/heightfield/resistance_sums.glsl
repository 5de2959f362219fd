#define SUM_PEAKS body_peaks
#define SUM_COUNTS body_counts
#define SUM_WORDS body_sums
