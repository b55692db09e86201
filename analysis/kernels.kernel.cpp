// Analysis's one entry of an instruction set's library.
#include "analysis/kernels.h"

#include "analysis/kernel_functions.h"

extern "C" __attribute__((visibility("default"))) const void* halfslope_analysis_kernels() {
  static constexpr halfslope::AnalysisKernels kTable = {halfslope::kernel::pair_products};
  return &kTable;
}
