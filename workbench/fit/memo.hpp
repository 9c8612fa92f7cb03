// Results that several threads ask for, each made once.
#pragma once

#include <map>
#include <mutex>

namespace etlc::fit {

template <class Key, class Value>
class Memo {
public:
    /// `make()` gives the value of the key. Those who ask meanwhile wait.
    template <class Make>
    const Value& get(const Key& key, const Make& make) {
        Entry& entry = entry_of(key);
        std::call_once(entry.once, [&] { entry.value = make(); });
        return entry.value;
    }

private:
    struct Entry {
        std::once_flag once;
        Value value;
    };

    Entry& entry_of(const Key& key) {
        const std::lock_guard lock(finding_);
        return entries_[key];
    }

    std::mutex finding_;
    std::map<Key, Entry> entries_;
};

}  // namespace etlc::fit
