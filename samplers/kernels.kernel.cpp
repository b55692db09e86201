// The samplers' one entry of an instruction set's library.
#include "samplers/kernels.h"

#include "samplers/kernel_functions.h"

extern "C" __attribute__((visibility("default"))) const void* halfslope_sampler_kernels() {
  namespace kernel = halfslope::kernel;
  static constexpr halfslope::SamplerKernels kTable = {kernel::random_words,      kernel::halton_owen,
                                                       kernel::halton_owen_table, kernel::sobol_owen,
                                                       kernel::sobol_owen_table,  kernel::sobol_owen_fast};
  return &kTable;
}
