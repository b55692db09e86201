// The estimators' one entry of an instruction set's library.
#include "estimators/kernels.h"

#include "estimators/kernel_functions.h"

namespace halfslope::kernel {
namespace {

template <class T>
void sample(const LightingCall<T>& call) {
  const bool area = call.technique == LightingTechnique::kLight || call.technique == LightingTechnique::kSurface;
  area ? sample_area(call) : sample_direction(call);
}

}  // namespace
}  // namespace halfslope::kernel

extern "C" __attribute__((visibility("default"))) const void* halfslope_estimator_kernels() {
  using namespace halfslope::kernel;
  static constexpr halfslope::EstimatorKernels kTable = {
      sample<float>,      sample<double>,      fold<float>,          fold<double>,       accumulate<float>,
      accumulate<double>, sample_point<float>, sample_point<double>, trace_paths<float>, trace_paths<double>,
  };
  return &kTable;
}
