// The integrands' one entry of an instruction set's library.
#include <iterator>

#include "scenes/integrand_formula.h"

extern "C" __attribute__((visibility("default"))) const void* halfslope_integrand_kernels() {
  using namespace halfslope::kernel;
  static const halfslope::IntegrandFamily kFamilies[] = {step_kernels(), ramp_kernels(),    smooth_kernels(),
                                                         genz_kernels(), product_kernels(), singular_kernels(),
                                                         mis_kernels()};
  static const halfslope::IntegrandKernels kTable = {kFamilies, std::size(kFamilies)};
  return &kTable;
}
