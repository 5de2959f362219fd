#define SUM_PEAKS support_peaks
#define SUM_COUNTS support_counts
#define SUM_WORDS support_sums
