#include "core/yaml/schema_recording.h"

#include <algorithm>
#include <stdexcept>

namespace understudy {
namespace {

using Run = std::function<void(SchemaRecording&)>;

SchemaRecording record(const Run& run, std::vector<Decision> path) {
  SchemaRecording recording(std::move(path));
  run(recording);
  return recording;
}

/// Both runs ask for the same, but for the value of `key` itself, which one of them may not have.
bool same_keys(const SchemaRecording& a, const SchemaRecording& b, const std::string& key) {
  const auto others = [&key](const SchemaRecording& recording) {
    std::vector<const KeySchema*> keys;
    for (const KeySchema& schema : recording.keys())
      if (schema.key != key) keys.push_back(&schema);
    return keys;
  };
  return std::ranges::equal(others(a), others(b),
                            [](const KeySchema* x, const KeySchema* y) { return *x == *y; });
}

void explore(const Run& run, const std::vector<Decision>& path, std::vector<MapVariant>& variants,
             const std::vector<Condition>& when) {
  const SchemaRecording first = record(run, path);
  for (std::size_t i = path.size(); i < first.decisions().size(); ++i) {
    const Decision& decision = first.decisions()[i];
    const auto answered = [&](std::size_t answer) {
      std::vector<Decision> with(first.decisions().begin(),
                                 first.decisions().begin() + static_cast<std::ptrdiff_t>(i) + 1);
      with.back().chosen = answer;
      return with;
    };
    bool matters = false;
    for (std::size_t answer = 1; answer < decision.answers.size() && !matters; ++answer)
      matters = !same_keys(first, record(run, answered(answer)), decision.key);
    if (!matters) continue;
    for (std::size_t answer = 0; answer < decision.answers.size(); ++answer) {
      std::vector<Condition> further = when;
      further.push_back({decision.key, decision.answers[answer]});
      explore(run, answered(answer), variants, further);
    }
    return;
  }
  variants.push_back({when, first.keys()});
}

}  // namespace

std::string SchemaRecording::decide(const std::string& key, const std::vector<std::string>& answers) {
  const std::string question = key + (answers.front() == kPresent ? "?" : "");
  if (const auto before = answered_.find(question); before != answered_.end()) return before->second;
  if (next_ == decisions_.size()) decisions_.push_back({key, answers, 0});
  const Decision& decision = decisions_[next_++];
  if (decision.key != key)
    throw std::logic_error("a reader asked for '" + key + "', before for '" + decision.key + "'");
  return answered_[question] = decision.answers[decision.chosen];
}

KeySchema* SchemaRecording::find(const std::string& key) {
  const auto found =
      std::find_if(keys_.begin(), keys_.end(), [&](const KeySchema& s) { return s.key == key; });
  return found == keys_.end() ? nullptr : &*found;
}

void SchemaRecording::look_for(const std::string& key) {
  if (find(key) == nullptr) keys_.emplace_back().key = key;
}

void SchemaRecording::ask(KeySchema schema) {
  const auto looked = answered_.find(schema.key + "?");
  schema.required = looked == answered_.end() || looked->second != kPresent;
  if (KeySchema* known = find(schema.key))
    *known = std::move(schema);
  else
    keys_.push_back(std::move(schema));
}

MapSchema explore(const Run& run) {
  MapSchema schema;
  explore(run, {}, schema.variants, {});
  return schema;
}

}  // namespace understudy
