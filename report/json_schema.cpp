#include "report/json_schema.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace understudy::report {
namespace {

using Json = nlohmann::ordered_json;
using Type = KeySchema::Type;

/// One thing that decides which keys follow, and the answers to it that this is about.
struct Choice {
  std::string key;
  bool presence = false;  ///< whether the key is there; else: its word
  std::vector<std::string> answers;
  bool operator==(const Choice&) const = default;
};

/// Something that holds when all choices are answered so.
struct Rule {
  std::vector<Choice> when;
  std::size_t value = 0;  ///< its number among Values
};

/// Each value once: rules are compared by its number.
class Values {
 public:
  std::size_t number_of(Json value) {
    const auto at = std::find(all_.begin(), all_.end(), value);
    if (at != all_.end()) return static_cast<std::size_t>(at - all_.begin());
    all_.push_back(std::move(value));
    return all_.size() - 1;
  }
  const Json& operator[](std::size_t number) const { return all_[number]; }

 private:
  std::vector<Json> all_;
};

Choice choice_of(const Condition& condition) {
  const bool presence = condition.word == kPresent || condition.word == kAbsent;
  return {condition.key, presence, {condition.word}};
}

bool same_question(const Choice& a, const Choice& b) { return a.key == b.key && a.presence == b.presence; }

const Choice* find(const std::vector<Choice>& choices, const Choice& question) {
  for (const Choice& choice : choices)
    if (same_question(choice, question)) return &choice;
  return nullptr;
}

/// Nothing in `questions` tells the two apart.
bool compatible(const Rule& a, const Rule& b, const std::vector<Choice>& questions) {
  return std::all_of(questions.begin(), questions.end(), [&](const Choice& question) {
    const Choice *in_a = find(a.when, question), *in_b = find(b.when, question);
    return !in_a || !in_b || in_a->answers == in_b->answers;
  });
}

/// The questions without which rules of different values could not be told apart.
std::vector<Choice> needed_questions(const std::vector<Rule>& rules) {
  std::vector<Choice> questions;
  for (const Rule& rule : rules)
    for (const Choice& choice : rule.when)
      if (!find(questions, choice)) questions.push_back(choice);
  for (std::size_t i = questions.size(); i-- > 0;) {
    std::vector<Choice> without = questions;
    without.erase(without.begin() + static_cast<std::ptrdiff_t>(i));
    bool clash = false;
    for (std::size_t a = 0; a < rules.size() && !clash; ++a)
      for (std::size_t b = 0; b < a && !clash; ++b)
        clash = rules[a].value != rules[b].value && compatible(rules[a], rules[b], without);
    if (!clash) questions = without;
  }
  return questions;
}

/// Puts the answers of `b` into `a` where the two rules differ in one choice only.
bool merge(Rule& a, const Rule& b) {
  if (a.value != b.value || a.when.size() != b.when.size()) return false;
  Choice* different = nullptr;
  for (std::size_t i = 0; i < a.when.size(); ++i) {
    if (a.when[i] == b.when[i]) continue;
    if (different || !same_question(a.when[i], b.when[i])) return false;
    different = &a.when[i];
  }
  if (!different) return true;
  std::vector<std::string>& answers = different->answers;
  for (const std::string& answer : find(b.when, *different)->answers)
    if (std::find(answers.begin(), answers.end(), answer) == answers.end()) answers.push_back(answer);
  if (different->presence)
    std::erase_if(a.when, [](const Choice& c) { return c.presence && c.answers.size() > 1; });
  return true;
}

/// The same rules, told with as few choices as can be.
std::vector<Rule> simplified(std::vector<Rule> rules) {
  const std::vector<Choice> questions = needed_questions(rules);
  for (Rule& rule : rules)
    std::erase_if(rule.when, [&](const Choice& choice) { return !find(questions, choice); });
  for (bool merged = true; merged;) {
    merged = false;
    for (std::size_t a = 0; a < rules.size(); ++a)
      for (std::size_t b = a + 1; b < rules.size();)
        if (merge(rules[a], rules[b])) {
          rules.erase(rules.begin() + static_cast<std::ptrdiff_t>(b));
          merged = true;
        } else {
          ++b;
        }
  }
  return rules;
}

Json condition_of(const Choice& choice) {
  const std::size_t dot = choice.key.find('.');
  const std::string key = choice.key.substr(0, dot);
  if (!choice.presence)
    return {{"properties", {{key, {{"enum", choice.answers}}}}}, {"required", Json::array({key})}};
  Json present{{"required", Json::array({key})}};
  if (dot != std::string::npos)
    present["properties"][key]["required"] = Json::array({choice.key.substr(dot + 1)});
  return choice.answers.front() == kAbsent ? Json{{"not", present}} : present;
}

Json condition_of(const std::vector<Choice>& choices) {
  if (choices.size() == 1) return condition_of(choices.front());
  Json all;
  for (const Choice& choice : choices) all["allOf"].push_back(condition_of(choice));
  return all;
}

class Writer {
 public:
  Json object(const MapSchema& schema);
  const Json& definitions() const { return definitions_; }

 private:
  Json object(const std::vector<MapVariant>& variants);
  Json value(const KeySchema& key);
  Json list(const KeySchema& key);
  Json reference(const MapSchema& schema, const std::string& key);

  Json definitions_ = Json::object();
  std::vector<std::pair<MapSchema, std::string>> defined_;
};

Json number(const KeySchema& key, const char* type) {
  Json json{{"type", type}};
  const auto limit = [&](const char* name, double bound) {
    if (!std::isfinite(bound)) return;
    const bool whole = bound == std::floor(bound) && std::abs(bound) < 1e15;
    json[name] = whole ? Json(static_cast<long long>(bound)) : Json(bound);
  };
  limit("minimum", key.bounds.low);
  limit("maximum", key.bounds.high);
  return json;
}

Json text(const KeySchema& key) {
  if (key.words.empty()) return {{"type", "string"}, {"minLength", 1}};
  Json words = Json::array();
  for (const std::string& word : key.words) {
    words.push_back(word);
    if (word == "1") words.push_back(1);  // without quotes a number to YAML, and the same to our reader
  }
  return {{"enum", words}};
}

Json Writer::reference(const MapSchema& schema, const std::string& key) {
  for (const auto& [known, name] : defined_)
    if (known == schema) return {{"$ref", "#/definitions/" + name}};
  std::string name = key;
  for (int i = 2; definitions_.contains(name); ++i) name = key + "-" + std::to_string(i);
  definitions_[name] = nullptr;  // takes the name and its place
  Json written = object(schema);
  definitions_[name] = std::move(written);
  defined_.emplace_back(schema, name);
  return {{"$ref", "#/definitions/" + name}};
}

Json Writer::list(const KeySchema& key) {
  if (key.maps.empty())  // of words, where one may stand without brackets
    return {{"type", {"array", "string"}}, {"minItems", 1}, {"items", {{"type", {"string", "number"}}}}};
  Json json{{"type", "array"}, {"minItems", std::max<std::size_t>(key.count, 1)}};
  if (key.count > 0) json["maxItems"] = key.count;
  if (key.maps.size() == 1) {
    json["items"] = reference(key.maps.front(), key.key);
    return json;
  }
  for (const MapSchema& map : key.maps) json["items"].push_back(reference(map, key.key));
  return json;
}

Json Writer::value(const KeySchema& key) {
  Json json;
  switch (key.type) {
    case Type::number:
      json = number(key, "number");
      break;
    case Type::integer:
      json = number(key, "integer");
      break;
    case Type::text:
      json = text(key);
      break;
    case Type::numbers:
      json = {{"type", "array"}, {"minItems", std::max<std::size_t>(key.count, 1)}};
      if (key.count > 0) json["maxItems"] = key.count;
      json["items"] = number(key, "number");
      break;
    case Type::map:
      json["allOf"].push_back(reference(key.maps.front(), key.key));
      break;
    case Type::list:
      json = list(key);
      break;
    case Type::none:
      return false;
  }
  json["description"] = key.about + (key.unit.empty() ? "" : " [" + key.unit + "]");
  return json;
}

/// By the condition: what holds where it does.
using Consequences = std::vector<std::pair<std::vector<Choice>, Json>>;

Json& under(Consequences& all, const std::vector<Choice>& when) {
  for (auto& [condition, then] : all)
    if (condition == when) return then;
  return all.emplace_back(when, Json::object()).second;
}

Json Writer::object(const std::vector<MapVariant>& variants) {
  std::vector<std::string> names;
  for (const MapVariant& variant : variants)
    for (const KeySchema& key : variant.keys)
      if (std::find(names.begin(), names.end(), key.key) == names.end()) names.push_back(key.key);
  Json json{{"type", "object"}, {"additionalProperties", false}, {"properties", Json::object()}};
  Json required = Json::array();
  Consequences consequences;
  constexpr std::size_t kOptional = 0, kNeeded = 1;
  for (const std::string& name : names) {
    Values known;
    const std::size_t none = known.number_of(Json(false));
    std::vector<Rule> values, needs;
    for (const MapVariant& variant : variants) {
      Rule rule;
      bool absent = false;
      for (const Condition& condition : variant.when) {
        if (condition.key.starts_with("#")) continue;
        absent = absent || (condition.key == name && condition.word == kAbsent);
        rule.when.push_back(choice_of(condition));
      }
      const auto key = std::find_if(variant.keys.begin(), variant.keys.end(),
                                    [&](const KeySchema& schema) { return schema.key == name; });
      const bool asked = key != variant.keys.end() && key->type != Type::none;
      needs.push_back({rule.when, asked && key->required ? kNeeded : kOptional});
      rule.value = asked ? known.number_of(value(*key)) : none;
      if (asked || !absent) values.push_back(rule);
    }
    needs = simplified(needs);
    for (const Rule& rule : needs)
      if (rule.value == kNeeded && rule.when.empty())
        required.push_back(name);
      else if (rule.value == kNeeded)
        under(consequences, rule.when)["required"].push_back(name);
    values = simplified(values);
    std::vector<std::size_t> forms;
    for (const Rule& rule : values)
      if (rule.value != none && std::find(forms.begin(), forms.end(), rule.value) == forms.end())
        forms.push_back(rule.value);
    if (forms.empty()) continue;
    const Json& first = known[forms.front()];
    json["properties"][name] = forms.size() == 1 ? first : Json{{"description", first["description"]}};
    for (const Rule& rule : values)
      if (!rule.when.empty() && (forms.size() > 1 || rule.value == none))
        under(consequences, rule.when)["properties"][name] = known[rule.value];
  }
  if (!required.empty()) json["required"] = required;
  for (const auto& [when, then] : consequences)
    json["allOf"].push_back({{"if", condition_of(when)}, {"then", then}});
  return json;
}

Json Writer::object(const MapSchema& schema) {
  // What no key tells cannot be a condition: any of the forms will do.
  std::vector<std::pair<std::vector<Condition>, std::vector<MapVariant>>> forms;
  for (const MapVariant& variant : schema.variants) {
    std::vector<Condition> hidden;
    for (const Condition& condition : variant.when)
      if (condition.key.starts_with("#")) hidden.push_back(condition);
    auto form = std::find_if(forms.begin(), forms.end(), [&](const auto& f) { return f.first == hidden; });
    if (form == forms.end()) form = forms.insert(forms.end(), {hidden, {}});
    form->second.push_back(variant);
  }
  std::vector<Json> objects;
  for (const auto& [hidden, variants] : forms)
    if (Json form = object(variants); std::find(objects.begin(), objects.end(), form) == objects.end())
      objects.push_back(std::move(form));
  return objects.size() == 1 ? objects.front() : Json{{"anyOf", objects}};
}

}  // namespace

std::string json_schema(const MapSchema& schema, const std::string& title) {
  Writer writer;
  Json json{{"$schema", "http://json-schema.org/draft-07/schema#"}, {"title", title}};
  json.update(writer.object(schema));
  if (!writer.definitions().empty()) json["definitions"] = writer.definitions();
  return json.dump(1) + "\n";
}

}  // namespace understudy::report
