#include "experiments/menu.h"

#include <fmt/format.h>

#include <charconv>

namespace halfslope {

const CLI::Validator& whole_number() {
  static const CLI::Validator validator(
      [](std::string& text) {
        std::uint64_t value = 0;
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data(), end, value);
        if (error == std::errc() && rest == end) return std::string();
        return fmt::format("found '{}'; allowed: an integer from 0 to 2^64 - 1", text);
      },
      "");
  return validator;
}

void add_seed(CLI::App& command, std::uint64_t& seed) {
  command.add_option("--seed", seed, "of the random numbers")
      ->capture_default_str()
      ->type_name("S")
      ->check(whole_number());
}

void add_threads(CLI::App& command, int& threads, const std::string& help) {
  command.add_option("--threads", threads, help)->check(CLI::Range(1, 4096));
}

}  // namespace halfslope
