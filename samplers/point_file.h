// Points from elsewhere: text files with one point a line.
#pragma once

#include <cstdint>
#include <deque>
#include <filesystem>

namespace halfslope {

/// What becomes of coordinates outside [0, 1): an error; x − ⌊x⌋; or the nearest coordinate, 0 or 1 − 2⁻⁵³.
enum class Outside { kRefuse, kWrap, kClamp };

/// What a file may hold.
struct PointFileLimits {
  std::uint64_t coordinates = std::uint64_t{1} << 27;  ///< 8 bytes of memory each
  std::size_t line = std::size_t{1} << 20;             ///< bytes
};

/// Sets of points, all of one size.
struct PointFile {
  int dims = 0;
  std::uint64_t count = 0;  ///< points of a set
  std::uint64_t sets = 0;
  std::deque<std::uint64_t> words;  ///< [set][point][dim], x = word · 2⁻⁵³
  std::uint64_t moved = 0;          ///< coordinates that were outside and were wrapped or clamped
  std::uint64_t hash = 0;           ///< of all of the above but `moved`
};

/// Reads a file of points.
///
/// A line holds a point: its coordinates as decimal numbers, separated by blanks, tabs, commas or semicolons, always as
/// many. Each is read to the nearest binary64 number and cut to 53 bits behind the point. Lines that begin with # or //
/// are comments, and a comment between points ends a set; blank lines mean nothing. The first line may name the
/// columns. Lines end with LF or CRLF.
///
/// Memory is that of the coordinates and of two of the longest lines, whatever the file. Errors begin with the file
/// and the line, and say what was found and what is allowed. Error(kBadInput): no such file, a folder, no points,
/// coordinates that are no finite numbers or lie outside [0, 1), lines with different numbers of them, sets of
/// different sizes, more than the limits allow. Error(kIo) where the file cannot be read.
PointFile read_point_file(const std::filesystem::path& path, Outside outside, const PointFileLimits& limits = {});

}  // namespace halfslope
