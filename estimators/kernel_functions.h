// The kernels themselves, inside one instruction set's library.
#pragma once

#include "estimators/kernels.h"

namespace halfslope::kernel {

/// Techniques light and surface.
template <class T>
void sample_area(const LightingCall<T>& call);
/// Techniques bsdf, hemisphere and cosine.
template <class T>
void sample_direction(const LightingCall<T>& call);
/// Direct lighting at one point of any scene.
template <class T>
void sample_point(const PointCall<T>& call);
/// Path tracing.
template <class T>
void trace_paths(const PathCall<T>& call);
template <class T>
void fold(const FoldCall<T>& call);
/// The part of `fold` that fills call.regression, from the densities' ratios.
template <class T>
void regress(const FoldCall<T>& call);
template <class T>
void accumulate(const T* const* values, int outputs, int samples, double* sums, double* compensations);

}  // namespace halfslope::kernel
