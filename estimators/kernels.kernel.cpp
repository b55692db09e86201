// The estimators' one entry of an instruction set's library.
#include "estimators/kernels.h"

#include "estimators/kernel_functions.h"

extern "C" __attribute__((visibility("default"))) const void* halfslope_estimator_kernels() {
  using namespace halfslope::kernel;
  static constexpr halfslope::EstimatorKernels kTable = {
      sample_light<float>, sample_light<double>, sample_bsdf<float>, sample_bsdf<double>,
      fold<float>,         fold<double>,         accumulate<float>,  accumulate<double>,
  };
  return &kTable;
}
