// Names that carry parameters: "genz-gaussian:d=4", "pcf:bins=200,max=0.1".
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

/// A parameter that a name may carry; without `fallback` it must.
struct Parameter {
  std::string name;
  std::optional<double> fallback = std::nullopt;
};

/// The values of parameters, by name; every one that was allowed is there.
class Parameters {
 public:
  explicit Parameters(std::map<std::string, double> values) : values_(std::move(values)) {}
  double number(const std::string& name) const { return values_.at(name); }
  /// A whole number from `least` to `most`; Error(kBadInput), which begins with `subject`, for any other.
  int whole(const std::string& subject, const std::string& name, int least, int most) const;

 private:
  std::map<std::string, double> values_;
};

/// The part of `name` before ':' and, where there is one, the text after it.
struct SplitName {
  std::string_view head;
  std::optional<std::string_view> parameters;
};
SplitName split_name(std::string_view name);

/// Reads "a=1,b=2". `subject`, such as "scene 'pcf:bins=2'", begins each message. Error(kBadInput) for parameters that
/// are unknown (naming the nearest), missing, given twice, or no finite decimal numbers.
Parameters parse_parameters(const std::string& subject, std::optional<std::string_view> text,
                            std::span<const Parameter> allowed);

}  // namespace halfslope
