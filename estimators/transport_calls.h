// What transport kernels are asked for: plain data across the border to an instruction set's library.
#pragma once

#include <cstddef>
#include <cstdint>

#include "estimators/transport_scene.h"
#include "estimators/transport_techniques.h"

namespace halfslope {

/// The rays of one pixel: with (x, y) the offset from its centre in pixels and (a, b) a point of the unit disk, from
/// origin + x origin_x + y origin_y + a lens_u + b lens_v to origin + x origin_x + y origin_y + focus (direction +
/// x direction_x + y direction_y).
template <class T>
struct CameraData {
  T origin[3], origin_x[3], origin_y[3];
  T direction[3], direction_x[3], direction_y[3];
  T lens_u[3], lens_v[3];
  T focus;
  bool lens;                 ///< whether the lens has a size, and takes two dimensions
  const float* filter;       ///< where it is drawn from: inverse distribution function at i/(filter_size − 1)
  std::int32_t filter_size;  ///< 0: no filter, the pixel's centre
};

/// Where the numbers of a path stand among its dimensions; −1: not needed.
struct PathDims {
  std::int32_t film = -1, lens = -1;
  std::int32_t first_vertex = 0, per_vertex = 0;
  std::int32_t choice = -1, light = -1, lobe = -1, bsdf = -1, roulette = -1;  ///< within a vertex
};

/// One path at each of `count` points. Slot 0 receives what no other technique could have found, weighted 1 by every
/// heuristic; slots 1 + 2k and 2 + 2k the terms of vertex k's light and BSDF samples: `channels` values, then the
/// densities of the light technique and the BSDF's.
template <class T>
struct PathCall {
  const TransportScene<T>* scene;
  const CameraData<T>* camera;
  std::int32_t channels;
  std::int32_t max_depth;  ///< 1: what is seen; 2: scattered once; ...
  std::int32_t rr_depth;   ///< Russian roulette after so many vertices; 0: none
  LightWay way;
  PathDims dims;
  const std::uint32_t* const* high;  ///< of each dimension
  const std::uint32_t* const* low;
  std::size_t count, stride;
  T* terms;
};

/// The point that a pixel sees, in the kernels' lengths.
template <class T>
struct StartPoint {
  T position[3], normal[3];
  T s[3], t[3], n[3];  ///< the shading frame, on the side that is seen
  T wo[3];             ///< towards the eye, in the frame
  T u, v;
  std::int32_t material, piece;
};

/// One sample of a technique at each of `count` points, all at one start. high[d], low[d]: its own dimensions.
template <class T>
struct PointCall {
  const TransportScene<T>* scene;
  const StartPoint<T>* start;
  TransportTechnique technique;
  std::int32_t channels;
  bool choose;  ///< whether the first dimension chooses a light, or a lobe
  const std::uint32_t* const* high;
  const std::uint32_t* const* low;
  std::size_t count;
  T* const* values;
  T* const* pdfs;  ///< kTransportTechniques of them, null where not asked for
};

}  // namespace halfslope
