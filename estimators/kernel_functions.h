// The kernels themselves, inside one instruction set's library.
#pragma once

#include "estimators/kernels.h"

namespace halfslope::kernel {

template <class T>
void sample_light(const LightingCall<T>& call);
template <class T>
void sample_bsdf(const LightingCall<T>& call);
template <class T>
void fold(const FoldCall<T>& call);
template <class T>
void accumulate(const T* const* values, int outputs, int samples, double* sums, double* compensations);

}  // namespace halfslope::kernel
