// A data set of robot learning in the format of LeRobot: rows in Parquet, and for each camera a
// video, or images in the rows.
// Takes: its folder, which holds meta/info.json of version 2.0, 2.1 or 3.0. Gives: its episodes,
// with the places of their rows and frames. Keeps true: contradictions between metadata and files
// are reported; an incomplete episode is known as one; nothing outside the folder is read. Source:
// huggingface/lerobot, src/lerobot/datasets.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "data/traces/trace.hpp"
#include "diag/diag.hpp"

namespace etlc::recordings {

/// The part of a video that shows an episode.
struct Clip {
    std::string path;       ///< in the folder
    double begin = 0;       ///< seconds
    double end = 0;         ///< 0: unknown
    bool is_whole = false;  ///< the clip is the whole video
};

struct DatasetEpisode {
    std::uint64_t index = 0;
    std::uint64_t length = 0;  ///< rows
    std::vector<std::string> tasks;
    std::string rows;  ///< the file in the folder
    std::map<std::string, Clip>
        clips;  ///< by camera; none for cameras whose images are in the rows
};

/// An episode in a video.
struct VideoPart {
    const DatasetEpisode* episode = nullptr;
    const std::string* camera = nullptr;
    const Clip* clip = nullptr;
};

/// The episodes in a video, in the order in which it shows them.
struct VideoParts {
    std::vector<VideoPart> parts;
    std::string fault;  ///< why its frames cannot be assigned to episodes; empty: they can
    std::optional<std::uint64_t> frames;  ///< the number of frames that the video must have
    std::string last;                     ///< "episode 7 (6 rows, from 1.2 to 1.8 s)"
};

struct Feature {
    std::string name;
    std::string type;  ///< "float32", "video", "image"
};

class Dataset {
public:
    /// Reads the metadata. Failures are E0850 and name the file in the folder.
    static diag::Result<std::shared_ptr<Dataset>> read(const std::string& folder);
    /// Reads the metadata once per process.
    static diag::Result<std::shared_ptr<Dataset>> known(const std::string& folder);

    const std::string& folder() const { return folder_; }
    double fps() const { return fps_; }
    /// 2 or 3, of the version.
    int major_version() const { return major_; }
    const std::vector<Feature>& features() const { return features_; }
    std::vector<std::string> cameras() const;
    /// The cameras that have videos.
    std::vector<std::string> videos() const;
    const std::vector<DatasetEpisode>& episodes() const { return episodes_; }
    const DatasetEpisode* episode(std::uint64_t index) const;
    std::string path_of(const std::string& file) const { return folder_ + "/" + file; }

    /// Contradictions in the metadata: "meta/info.json promises 50 episodes, ...".
    const std::vector<std::string>& contradictions() const { return contradictions_; }
    /// Says how the rows of an episode differ from the metadata; empty: they do not. Reads the file
    /// of the rows.
    std::string lack(const DatasetEpisode& episode);
    /// Returns all episodes that the metadata place in a video.
    const VideoParts& parts_of(const std::string& video);

private:
    friend class DatasetReader;

    /// The rows of an episode in its file.
    struct Found {
        std::uint64_t rows = 0;
        std::string lack;
    };

    const Found& found(const DatasetEpisode& episode);
    void survey(const std::string& rows);
    void judge(VideoParts& video);

    std::string folder_;
    double fps_ = 0;
    int major_ = 0;
    std::vector<Feature> features_;
    std::vector<DatasetEpisode> episodes_;
    std::vector<std::string> contradictions_;
    std::mutex lock_;                                              ///< guards the members below
    std::map<std::string, std::map<std::uint64_t, Found>> found_;  ///< by file of rows
    std::map<std::string, VideoParts> parts_;                      ///< by video
};

/// Adds a file in the folder to a failure.
diag::Failure in_part(const std::string& file, diag::Failure failure);
/// Adds to `why`, the reason that a path leads to no recording, the data set that may be meant.
std::string with_dataset_meant(const std::string& why, const std::string& path);
/// Returns the path of an episode: "pusht:000003".
std::string episode_path(const std::string& folder, std::uint64_t index);
/// Returns the name of a folder, also for "." and "sets/pusht/": the episodes that `etlc embed`
/// makes of a data set begin with it.
std::string name_of_folder(const std::string& folder);

/// The values of the fields of a template.
struct PathNames {
    std::map<std::string, std::uint64_t> numbers;
    std::map<std::string, std::string> words;
};

/// Fills in a template of Python,
/// "data/chunk-{episode_chunk:03d}/episode_{episode_index:06d}.parquet". The path does not lead out
/// of the folder. Failures: E0850.
diag::Result<std::string> path_from(const std::string& pattern, const PathNames& names);

}  // namespace etlc::recordings
