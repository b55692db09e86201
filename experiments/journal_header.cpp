#include "experiments/journal_header.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace halfslope {
namespace {

constexpr std::string_view kMagicLine = "halfslope journal 3\n";

}  // namespace

std::string journal_preamble(const JournalHeader& header) {
  const nlohmann::json json = {
      {"spec", header.spec_hash}, {"version", header.version}, {"isa_class", header.isa_class}};
  return std::string(kMagicLine) + json.dump() + "\n";
}

JournalStart read_journal_start(std::string_view beginning) {
  using Kind = JournalStart::Kind;
  if (beginning.size() < kMagicLine.size())
    return {kMagicLine.starts_with(beginning) ? Kind::kUnborn : Kind::kForeign, {}, 0};
  if (!beginning.starts_with(kMagicLine)) return {Kind::kForeign, {}, 0};
  const std::size_t newline = beginning.find('\n', kMagicLine.size());
  if (newline == std::string_view::npos) return {Kind::kUnborn, {}, 0};
  const std::string_view line = beginning.substr(kMagicLine.size(), newline - kMagicLine.size());
  const nlohmann::json json = nlohmann::json::parse(line, nullptr, false);
  const auto field = [&](const char* name) {
    const auto found = json.find(name);
    return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
  };
  if (!json.is_object()) return {Kind::kForeign, {}, 0};
  return {Kind::kJournal, {field("spec"), field("version"), field("isa_class")}, newline + 1};
}

std::string header_difference(const JournalHeader& there, const JournalHeader& here) {
  std::string text;
  const auto compare = [&](const char* name, const std::string& old, const std::string& mine) {
    if (old != mine) text += fmt::format("{}{} ({} there, {} here)", text.empty() ? "" : ", ", name, old, mine);
  };
  compare("spec", there.spec_hash, here.spec_hash);
  compare("version", there.version, here.version);
  compare("ISA class", there.isa_class, here.isa_class);
  return text;
}

}  // namespace halfslope
