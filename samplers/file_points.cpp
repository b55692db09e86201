#include "samplers/file_points.h"

#include <map>
#include <mutex>

#include "core/error.h"
#include "samplers/point_file.h"

namespace halfslope {
namespace {

const char* family_name(Outside outside) {
  if (outside == Outside::kWrap) return "file-wrap";
  return outside == Outside::kClamp ? "file-clamp" : "file";
}

class FilePoints final : public Sampler {
 public:
  FilePoints(const std::string& path, Outside outside, std::shared_ptr<const PointFile> file) : file_(std::move(file)) {
    const std::uint64_t sets = file_->sets;
    info_.name = fmt::format("{}:{}", family_name(outside), path);
    info_.description = fmt::format("{} set{} of {} points in {} dimensions, of a file", sets, sets == 1 ? "" : "s",
                                    file_->count, file_->dims);
    info_.reference = path;
    info_.sequence = true;
    info_.randomised = sets > 1;
    info_.unbiased = false;  // for all we know
    info_.max_dims = file_->dims;
    info_.max_count = file_->count;
    info_.replicates = static_cast<std::int64_t>(sets);
    info_.fingerprint = fmt::format("{} {:016x}", info_.name, file_->hash);
    info_.caveats.push_back(sets > 1 ? fmt::format("its {} sets are its replicates, whatever `replicates` says", sets)
                                     : "it holds one set, so it is deterministic, whatever `replicates` says");
    info_.caveats.push_back("the same points stand in every pixel, so pixels err alike");
    if (file_->moved > 0) {
      info_.caveats.push_back(fmt::format("{} of {} coordinates were outside [0, 1) and were {}", file_->moved,
                                          file_->words.size(),
                                          outside == Outside::kWrap ? "taken modulo 1" : "moved to the nearest end"));
    }
  }
  const SamplerInfo& info() const override { return info_; }

  void prepare(const PointRequest& request) override { replicate_ = request.replicate; }

  void fill(std::uint64_t begin, PointBlock& block) override {
    const auto dims = static_cast<std::size_t>(file_->dims);
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      // Lanes beyond the last set must hold something; nobody reads them.
      const std::uint64_t set = (replicate_ + lane) % file_->sets;
      const auto first = file_->words.begin() + static_cast<std::ptrdiff_t>((set * file_->count + begin) * dims);
      for (int d = 0; d < block.dims(); ++d) {
        std::uint32_t *high = block.high(d), *low = block.low(d);
        for (std::size_t s = 0; s < static_cast<std::size_t>(block.samples()); ++s) {
          const std::uint64_t word = first[static_cast<std::ptrdiff_t>(s * dims) + d];
          high[s * kLanes + lane] = static_cast<std::uint32_t>(word >> 21);
          if (low) low[s * kLanes + lane] = static_cast<std::uint32_t>(word & 0x1fffff);
        }
      }
    }
  }

 private:
  std::shared_ptr<const PointFile> file_;
  SamplerInfo info_;
  std::uint64_t replicate_ = 0;
};

/// The files that a family has read.
class Files {
 public:
  explicit Files(Outside outside) : outside_(outside) {}
  std::shared_ptr<const PointFile> get(const std::string& path) {
    const std::lock_guard lock(mutex_);  // others wait for a file that is being read
    auto& file = files_[path];
    if (!file) file = std::make_shared<const PointFile>(read_point_file(path, outside_));
    return file;
  }

 private:
  Outside outside_;
  std::mutex mutex_;
  std::map<std::string, std::shared_ptr<const PointFile>> files_;
};

void add_family(SamplerCatalogue& catalogue, Outside outside, const char* description) {
  SamplerInfo info;
  info.name = fmt::format("{}:PATH", family_name(outside));
  info.description = description;
  info.reference = "docs/samplers.md";
  info.sequence = true;
  info.unbiased = false;
  const auto files = std::make_shared<Files>(outside);
  catalogue.add_family(std::move(info), [outside, files](const std::string& path, const SamplerCatalogue&) {
    if (path.empty()) {
      fail(ExitCode::kBadInput, "sampler '{0}:': nothing stands after ':'; {0}:PATH names a file of points",
           family_name(outside));
    }
    return std::make_unique<FilePoints>(path, outside, files->get(path));
  });
}

}  // namespace

std::string point_file_of(std::string_view sampler) {
  constexpr std::string_view kPadded = "padded:";
  while (sampler.starts_with(kPadded)) sampler.remove_prefix(kPadded.size());
  const std::size_t colon = sampler.find(':');
  for (const Outside outside : {Outside::kRefuse, Outside::kWrap, Outside::kClamp}) {
    if (colon != std::string_view::npos && sampler.substr(0, colon) == family_name(outside))
      return std::string(sampler.substr(colon + 1));
  }
  return "";
}

void add_file_points(SamplerCatalogue& catalogue) {
  add_family(catalogue, Outside::kRefuse, "points of a text file, one a line; its sets are its replicates");
  add_family(catalogue, Outside::kWrap, "the same, coordinates outside [0, 1) taken modulo 1");
  add_family(catalogue, Outside::kClamp, "the same, coordinates outside [0, 1) moved to the nearest end");
}

}  // namespace halfslope
