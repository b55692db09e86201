#include "experiments/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

namespace halfslope {
namespace {

constexpr std::int64_t kDrawEveryMs = 100;
constexpr std::size_t kWidestBar = 24, kNarrowestBar = 6;
constexpr std::string_view kClearLine = "\r\x1b[K";

bool on_terminal() {
  const char* term = std::getenv("TERM");
  return ::isatty(STDERR_FILENO) == 1 && term != nullptr && std::string_view(term) != "dumb";
}

bool colour_wanted() {
  const char* no_color = std::getenv("NO_COLOR");
  return no_color == nullptr || *no_color == '\0';
}

int terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

// One write, so that lines of other threads do not cut it. Progress that cannot be shown is no reason to stop.
void show(const std::string& text) {
  [[maybe_unused]] const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
}

}  // namespace

std::string clock_time(double seconds) {
  const auto whole = static_cast<long long>(std::clamp(seconds, 0.0, 1e9) + 0.5);
  if (whole < 3600) return fmt::format("{}:{:02}", whole / 60, whole % 60);
  return fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

std::string short_count(double count) {
  constexpr std::array<const char*, 6> kPrefixes = {"", " k", " M", " G", " T", " P"};
  std::size_t prefix = 0;
  // 999.5 would be shown as 1000
  for (; std::abs(count) >= 999.5 && prefix + 1 < kPrefixes.size(); ++prefix) count /= 1000;
  const int decimals = prefix == 0 || count >= 99.95 ? 0 : count >= 9.995 ? 1 : 2;
  return fmt::format("{:.{}f}{}", count, decimals, kPrefixes[prefix]);
}

std::string progress_line(const ProgressState& state, int columns, bool colour) {
  const double fraction = state.total > 0 ? std::clamp(state.done / state.total, 0.0, 1.0) : 1.0;
  const double rate = state.seconds > 0 ? state.done / state.seconds : 0;
  const std::string left = state.done > 0 ? clock_time(state.seconds * (1 - fraction) / fraction) : "?:??";
  // Rounded down: 100 % means done.
  const std::string numbers = fmt::format("{:3d} %  {} elapsed, {} left, {} {}/s", static_cast<int>(fraction * 100),
                                          clock_time(state.seconds), left, short_count(rate), state.unit);
  const auto room = static_cast<std::size_t>(std::max(columns - 1, 1));  // the last column would wrap the cursor
  const std::size_t words = state.label.size() + numbers.size() + std::string_view(" [] ").size();
  if (words + kNarrowestBar > room) return numbers.substr(0, room);
  const std::size_t width = std::min(room - words, kWidestBar);
  const auto filled = static_cast<std::size_t>(fraction * static_cast<double>(width));
  const std::string bar = std::string(filled, '#') + std::string(width - filled, '-');
  return fmt::format("{} [{}{}{}] {}", state.label, colour ? "\x1b[32m" : "", bar, colour ? "\x1b[0m" : "", numbers);
}

std::string summary_line(const ProgressState& state) {
  const double rate = state.seconds > 0 ? state.done / state.seconds : 0;
  return fmt::format("done: {}, {} {} in {}, {} {}/s", state.label, short_count(state.done), state.unit,
                     clock_time(state.seconds), short_count(rate), state.unit);
}

Progress::Progress(std::string label, double total_work, bool quiet, std::string unit)
    : label_(std::move(label)),
      unit_(std::move(unit)),
      quiet_(quiet),
      terminal_(!quiet && on_terminal()),
      colour_(colour_wanted()),
      start_(std::chrono::steady_clock::now()),
      total_(total_work) {}

Progress::~Progress() {
  if (drawn_ && !finished_) show(std::string(kClearLine));
}

ProgressState Progress::state() const {
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start_;
  return {label_, done_.load(), total_.load(), elapsed.count(), unit_};
}

void Progress::advance(double work) {
  done_.fetch_add(work, std::memory_order_relaxed);
  if (!terminal_) return;
  const auto elapsed = std::chrono::steady_clock::now() - start_;
  const std::int64_t now = std::chrono::duration_cast<std::chrono::milliseconds>(elapsed).count();
  std::int64_t due = next_draw_ms_.load(std::memory_order_relaxed);
  if (now >= due && next_draw_ms_.compare_exchange_strong(due, now + kDrawEveryMs)) draw();
}

void Progress::draw() {
  const std::lock_guard lock(mutex_);
  if (finished_) return;
  drawn_ = true;
  show(std::string(kClearLine) + progress_line(state(), terminal_columns(), colour_));
}

void Progress::finish() {
  const std::lock_guard lock(mutex_);
  if (finished_) return;
  finished_ = true;
  if (quiet_) return;
  show((drawn_ ? std::string(kClearLine) : std::string()) + summary_line(state()) + "\n");
}

}  // namespace halfslope
