// The samplers' one entry of an instruction set's library.
#include "samplers/kernels.h"

#include "samplers/kernel_functions.h"

extern "C" __attribute__((visibility("default"))) const void* halfslope_sampler_kernels() {
  static constexpr halfslope::SamplerKernels kTable = {halfslope::kernel::random_words, halfslope::kernel::halton_owen,
                                                       halfslope::kernel::halton_owen_table};
  return &kTable;
}
