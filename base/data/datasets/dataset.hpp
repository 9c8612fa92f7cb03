// A data set of robot learning, as LeRobot writes it: rows in Parquet; of each camera a video, or
// images in the rows.
// Takes: its folder, which holds meta/info.json of version 2.0, 2.1 or 3.0. Gives: its episodes,
// where the rows and the frames of each lie, and what it lacks. Keeps true: what its metadata say
// and its files do not is named; an episode that lacks something is known as one; nothing outside
// the folder is read. Source: huggingface/lerobot, src/lerobot/datasets.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "diag/diag.hpp"

namespace etlc::data {

/// Where the frames of an episode are in the video of a camera.
struct Clip {
    std::string path;       ///< in the folder
    double begin = 0;       ///< seconds
    double end = 0;         ///< 0: it is not said
    bool is_whole = false;  ///< it is all of the video
};

struct DatasetEpisode {
    std::uint64_t index = 0;
    std::uint64_t length = 0;  ///< rows
    std::vector<std::string> tasks;
    std::string rows;                   ///< the file in the folder
    std::map<std::string, Clip> clips;  ///< by camera; without those whose images are in the rows
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
    std::string fault;  ///< why it is not known whose its frames are; empty: it is
    std::optional<std::uint64_t> frames;  ///< that the video has to have
    std::string last;                     ///< "episode 7 (6 rows, from 1.2 to 1.8 s)"
};

struct Feature {
    std::string name;
    std::string type;  ///< "float32", "video", "image"
};

class Dataset {
public:
    /// The metadata. Failures are E0850 and name the file in the folder.
    static diag::Result<std::shared_ptr<Dataset>> read(const std::string& folder);
    /// The same once a process: what it lacks, too, is looked for once.
    static diag::Result<std::shared_ptr<Dataset>> known(const std::string& folder);

    const std::string& folder() const { return folder_; }
    double fps() const { return fps_; }
    const std::vector<Feature>& features() const { return features_; }
    std::vector<std::string> cameras() const;
    /// Those of which there are videos.
    std::vector<std::string> videos() const;
    const std::vector<DatasetEpisode>& episodes() const { return episodes_; }
    const DatasetEpisode* episode(std::uint64_t index) const;
    std::string path_of(const std::string& file) const { return folder_ + "/" + file; }

    /// What contradicts the metadata as a whole: "meta/info.json promises 50 episodes, ...".
    const std::vector<std::string>& contradictions() const { return contradictions_; }
    /// Why the rows of an episode are not what the metadata say; empty: they are. Looks at the file
    /// that they are in.
    std::string lack(const DatasetEpisode& episode);
    /// All episodes that the metadata put into a video, whichever is asked for.
    const VideoParts& parts_of(const std::string& video);

private:
    friend class DatasetReader;

    /// Of an episode, what its file of rows holds.
    struct Found {
        std::uint64_t rows = 0;
        std::string lack;
    };

    const Found& found(const DatasetEpisode& episode);
    void survey(const std::string& rows);
    void judge(VideoParts& video);

    std::string folder_;
    double fps_ = 0;
    std::vector<Feature> features_;
    std::vector<DatasetEpisode> episodes_;
    std::vector<std::string> contradictions_;
    std::mutex lock_;                                              ///< of what follows
    std::map<std::string, std::map<std::uint64_t, Found>> found_;  ///< by file of rows
    std::map<std::string, VideoParts> parts_;                      ///< by video
};

/// Whether a folder is a data set.
bool is_dataset(const std::string& folder);

/// "pusht:3" or "pusht:0:50", the episodes from 0 up to 50: the folder, and which.
struct DatasetPath {
    std::string folder;
    std::uint64_t first = 0;
    std::uint64_t end = UINT64_MAX;
};
/// Nothing where the path is not one of a data set.
std::optional<DatasetPath> dataset_path(const std::string& path);
/// Why a path leads to no recording, with the data set that may have been meant.
std::string with_dataset_meant(const std::string& why, const std::string& path);
/// "pusht:000003"
std::string episode_path(const std::string& folder, std::uint64_t index);

}  // namespace etlc::data
