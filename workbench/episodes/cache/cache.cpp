#include "episodes/cache/cache.hpp"

#include <sys/stat.h>

#include <algorithm>
#include <limits>
#include <new>
#include <utility>

namespace etlc::episodes {

bool FreeBytes::take(std::uint64_t count, std::size_t bytes) {
    std::size_t left = left_;
    while (bytes == 0 || count <= left / bytes)
        if (left_.compare_exchange_weak(left, left - count * bytes)) return true;
    return false;
}

std::shared_ptr<const Identity> IdentityCache::find(const std::string& inputs) const {
    const std::lock_guard lock(changing_);
    const auto found = all_.find(inputs);
    return found == all_.end() ? nullptr : found->second;
}

void IdentityCache::add(const std::string& inputs, std::shared_ptr<const Identity> identity) {
    const std::lock_guard lock(changing_);
    all_.try_emplace(inputs, std::move(identity));
}

/// The samples of a channel: in float32 while that is exact, else in double.
class TraceCache::Column {
public:
    /// `has`: whether the file has the channel.
    Column(std::uint32_t width, bool has) : width_(width), has_(has) {}

    bool has() const { return has_; }
    std::size_t bytes_per_frame() const {
        return has_ ? width_ * (is_wide_ ? sizeof(double) : sizeof(float)) + 1 : 0;
    }
    void reserve(std::size_t frames) {
        if (!has_) return;
        present_.reserve(frames);
        is_wide_ ? wide_.reserve(frames * width_) : narrow_.reserve(frames * width_);
    }
    void shrink() {
        present_.shrink_to_fit();
        narrow_.shrink_to_fit();
        wide_.shrink_to_fit();
    }

    void add(bool present, const std::vector<double>& values) {
        if (!has_) return;
        present_.push_back(present ? 1 : 0);
        if (is_wide_)
            append(present, values, wide_);
        else if (!append(present, values, narrow_))
            widen(values);
    }
    /// Sets the values of a frame and returns whether it is present.
    bool get(std::uint64_t frame, std::vector<double>& values) const {
        if (!has_ || present_[frame] == 0) {
            values.assign(width_, std::numeric_limits<double>::quiet_NaN());
            return false;
        }
        const std::size_t at = frame * width_;
        if (is_wide_)
            values.assign(wide_.data() + at, wide_.data() + at + width_);
        else
            values.assign(narrow_.data() + at, narrow_.data() + at + width_);
        return true;
    }

private:
    /// Returns whether T has these values exactly. Written so that compilers vectorise it.
    template <class T>
    bool append(bool present, const std::vector<double>& values, std::vector<T>& all) const {
        const std::size_t at = all.size();
        all.resize(at + width_);
        bool exact = true;
        for (std::size_t i = 0; present && i < width_; ++i) {
            all[at + i] = static_cast<T>(values[i]);
            exact &= static_cast<double>(all[at + i]) == values[i] || values[i] != values[i];
        }
        return exact;
    }
    /// Changes to double; the last frame is not exact yet.
    void widen(const std::vector<double>& last) {
        wide_.reserve(narrow_.capacity());
        wide_.assign(narrow_.begin(), narrow_.end());
        std::copy(last.begin(), last.end(), wide_.end() - width_);
        narrow_ = {};
        is_wide_ = true;
    }

    std::uint32_t width_;
    bool has_;
    bool is_wide_ = false;
    std::vector<std::uint8_t> present_;
    std::vector<float> narrow_;
    std::vector<double> wide_;
};

/// A file whose samples are kept while it is read.
class TraceCache::Keeper final : public data::Trace {
public:
    /// `known`: what is kept of the file already.
    Keeper(TraceCache& all, std::string path, const Episode& known,
           std::unique_ptr<data::Trace> trace, const std::vector<data::Channel>& channels)
        : all_(all), path_(std::move(path)), trace_(std::move(trace)) {
        episode_.stamp = known.stamp;
        episode_.identities = known.identities;
        for (std::size_t c = 0; c < channels.size(); ++c) {
            if (known.columns.contains(key_of(channels[c]))) continue;
            new_.emplace_back(c, std::make_shared<Column>(channels[c].width, trace_->has(c)));
            episode_.columns.emplace(key_of(channels[c]), new_.back().second);
        }
    }
    Keeper(const Keeper&) = delete;
    Keeper& operator=(const Keeper&) = delete;
    ~Keeper() override { forget(); }

    diag::Result<bool> next(data::Sample& sample) override {
        auto more = trace_->next(sample);
        if (more && *more)
            add(sample);
        else if (more)
            conclude();
        return more;
    }
    std::uint64_t length() const override { return trace_->length(); }
    bool has(std::size_t channel) const override { return trace_->has(channel); }

private:
    void add(const data::Sample& sample) {
        if (new_.empty()) return;
        try {
            for (const auto& [channel, column] : new_)
                column->add(sample.present[channel], sample.values[channel]);
            ++episode_.frames;
            if (!make_room()) forget();
        } catch (const std::bad_alloc&) {  // the episode can be read again
            forget();
        }
    }
    /// Takes the bytes of the frames so far: at the first, of all if their number is known.
    bool make_room() {
        std::size_t bytes = 0;
        for (const auto& [channel, column] : new_) bytes += column->bytes_per_frame();
        if (episode_.frames == 1) {
            const std::uint64_t frames = std::max<std::uint64_t>(1, trace_->length());
            if (!all_.free_.take(frames, bytes)) return false;
            episode_.bytes = frames * bytes;
            for (const auto& [channel, column] : new_) column->reserve(frames);
        }
        const std::size_t needed = episode_.frames * bytes;
        if (needed <= episode_.bytes) return true;
        if (!all_.free_.take(1, needed - episode_.bytes)) return false;
        episode_.bytes = needed;
        return true;
    }
    void conclude() {
        if (new_.empty() || episode_.frames == 0) return;
        for (const auto& [channel, column] : new_) column->shrink();
        new_.clear();
        all_.keep(path_, std::move(episode_));
    }
    void forget() {
        if (new_.empty()) return;
        new_.clear();
        episode_.columns.clear();
        all_.free_.give_back(episode_.bytes);
    }

    TraceCache& all_;
    std::string path_;
    Episode episode_;
    std::unique_ptr<data::Trace> trace_;
    std::vector<std::pair<std::size_t, std::shared_ptr<Column>>> new_;  ///< by channel
};

/// A kept episode as a trace.
class TraceCache::Player final : public data::Trace {
public:
    Player(const Episode& episode, const std::vector<data::Channel>& channels)
        : frames_(episode.frames) {
        for (const data::Channel& channel : channels)
            columns_.push_back(episode.columns.at(key_of(channel)));
    }

    diag::Result<bool> next(data::Sample& sample) override {
        if (next_ == frames_) return false;
        sample.values.resize(columns_.size());
        sample.present.resize(columns_.size());
        for (std::size_t c = 0; c < columns_.size(); ++c)
            sample.present[c] = columns_[c]->get(next_, sample.values[c]);
        ++next_;
        return true;
    }
    std::uint64_t length() const override { return frames_; }
    bool has(std::size_t channel) const override { return columns_[channel]->has(); }

private:
    std::vector<std::shared_ptr<const Column>> columns_;
    std::uint64_t frames_;
    std::uint64_t next_ = 0;
};

diag::Result<TraceCache::Opened> TraceCache::open(const std::string& path,
                                                  const std::vector<data::Channel>& channels) {
    const auto stamp = stamp_of(path);
    Episode episode;
    if (stamp) episode = cached(path, *stamp);
    const bool all = std::all_of(channels.begin(), channels.end(), [&](const auto& channel) {
        const auto found = episode.columns.find(key_of(channel));
        return found != episode.columns.end() && (found->second->has() || channel.optional);
    });
    if (all && episode.frames > 0)
        return Opened{std::make_unique<Player>(episode, channels), episode.identities};
    auto trace = recordings::open_trace(path, channels);
    if (!trace) return trace.failure();
    if (!stamp) return Opened{std::move(*trace), nullptr};
    return Opened{std::make_unique<Keeper>(*this, path, episode, std::move(*trace), channels),
                  episode.identities};
}

std::optional<TraceCache::Stamp> TraceCache::stamp_of(const std::string& path) {
    struct stat found {};
    if (::stat(data::trace_file(path).c_str(), &found) != 0) return std::nullopt;
    if (!S_ISREG(found.st_mode) && !S_ISDIR(found.st_mode)) return std::nullopt;
    return Stamp{found.st_dev,         found.st_ino,          found.st_size,
                 found.st_mtim.tv_sec, found.st_mtim.tv_nsec, found.st_ctim.tv_sec,
                 found.st_ctim.tv_nsec};
}

TraceCache::Episode TraceCache::cached(const std::string& path, const Stamp& stamp) const {
    const std::lock_guard lock(changing_);
    const auto found = episodes_.find(path);
    if (found != episodes_.end() && found->second.stamp == stamp) return found->second;
    Episode none;
    none.stamp = stamp;
    none.identities = std::make_shared<IdentityCache>();
    return none;
}

void TraceCache::keep(const std::string& path, Episode more) {
    const std::lock_guard lock(changing_);
    Episode& kept = episodes_[path];
    const bool is_same = kept.stamp == more.stamp && kept.frames == more.frames;
    if (!is_same) {
        free_.give_back(kept.bytes);
        kept = std::move(more);
        return;
    }
    const std::size_t before = kept.columns.size();
    kept.columns.merge(more.columns);
    if (kept.columns.size() > before)
        kept.bytes += more.bytes;
    else  // another thread was faster
        free_.give_back(more.bytes);
}

}  // namespace etlc::episodes
