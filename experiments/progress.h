// How far a run is: a bar on a terminal, one line elsewhere. All on stderr; stdout is for data.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>
#include <string>

namespace halfslope {

/// What a bar shows.
struct ProgressState {
  std::string label;
  double done = 0, total = 0;
  double seconds = 0;            ///< since the start
  std::string unit = "samples";  ///< that work is counted in
};

/// "veach-mis [#####-----]  50 %  1:05 elapsed, 1:05 left, 43.1 M samples/s", narrower than
/// `columns`: the bar shrinks, then it and the label go, then the end is cut. Colour is ANSI.
std::string progress_line(const ProgressState& state, int columns, bool colour);

/// "done: veach-mis, 2.62 G samples in 1:05, 40.3 M samples/s"
std::string summary_line(const ProgressState& state);

/// "0:09", "1:05", "2:03:04".
std::string clock_time(double seconds);

/// "950", "43.1 k", "2.62 G": three digits and a prefix.
std::string short_count(double count);

/// Draws at most ten times a second, from whichever thread advances it. `quiet` draws nothing at all; where stderr is
/// not a terminal (or TERM is dumb), finish() prints the summary and that is all. NO_COLOR (https://no-color.org) is
/// respected.
class Progress {
 public:
  /// `total_work`: the units still to do; work found finished is not counted.
  Progress(std::string label, double total_work, bool quiet, std::string unit = "samples");
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  ///< clears an unfinished bar, so that an error stands on a line of its own

  /// Thread-safe and cheap: an atomic addition, and ten times a second a line.
  void advance(double work);

  /// For work whose amount turns out on the way: as much as is now expected in all.
  void set_total(double total_work) { total_ = total_work; }
  double done() const { return done_; }

  /// The summary instead of the bar. Further calls do nothing.
  void finish();

 private:
  ProgressState state() const;
  void draw();

  const std::string label_, unit_;
  const bool quiet_, terminal_, colour_;
  const std::chrono::steady_clock::time_point start_;
  std::atomic<double> total_, done_ = 0;
  std::atomic<std::int64_t> next_draw_ms_ = 0;
  std::mutex mutex_;  ///< of the terminal and `drawn_`, `finished_`
  bool drawn_ = false, finished_ = false;
};

}  // namespace halfslope
