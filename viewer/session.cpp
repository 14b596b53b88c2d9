#include "viewer/session.h"

#include "volume/base/error.h"

#include <nlohmann/json.hpp>

namespace pith {
namespace {

using Json = nlohmann::ordered_json;
constexpr std::array button_names = {"left", "right", "middle"};

Vec2d point_of(const Json& json) {
  const auto p = json.get<std::array<double, 2>>();
  if (!std::isfinite(p[0]) || !std::isfinite(p[1])) throw std::runtime_error("a coordinate is not finite");
  return {p[0], p[1]};
}

Event event_of(const Json& json) {
  Event event;
  const auto mouse = [&](const char* key, Event::Kind kind) {
    event.kind = kind;
    event.at = point_of(json.at(key));
    if (json.contains("button")) {
      const std::string name = json["button"];
      const auto found = std::find(button_names.begin(), button_names.end(), name);
      if (found == button_names.end()) throw std::runtime_error("'" + name + "' is no button");
      event.button = static_cast<Button>(found - button_names.begin());
    }
    event.shift = json.value("shift", false);
    event.control = json.value("control", false);
  };
  if (json.contains("press")) return mouse("press", Event::Kind::press), event;
  if (json.contains("drag")) return mouse("drag", Event::Kind::drag), event;
  if (json.contains("release")) return mouse("release", Event::Kind::release), event;
  if (json.contains("double_click")) return mouse("double_click", Event::Kind::double_click), event;
  if (json.contains("wheel")) {
    mouse("at", Event::Kind::wheel);
    event.amount = json["wheel"];
  } else if (json.contains("do")) {
    event.kind = Event::Kind::command;
    event.name = json["do"];
    event.text = json.value("with", "");
  } else if (json.contains("set")) {
    event.kind = Event::Kind::set;
    event.name = json["set"];
    event.text = json.at("to");
  } else if (json.contains("wait")) {
    event.kind = Event::Kind::wait;
  } else if (json.contains("picture")) {
    event.kind = Event::Kind::picture;
    event.text = json["picture"];
  } else {
    throw std::runtime_error("it says nothing that can be done");
  }
  return event;
}

Json json_of(const Event& event) {
  const auto point = Json{event.at.x(), event.at.y()};
  Json json;
  switch (event.kind) {
  case Event::Kind::press:
    json["press"] = point;
    break;
  case Event::Kind::drag:
    json["drag"] = point;
    break;
  case Event::Kind::release:
    json["release"] = point;
    break;
  case Event::Kind::double_click:
    json["double_click"] = point;
    break;
  case Event::Kind::wheel:
    json["wheel"] = event.amount, json["at"] = point;
    break;
  case Event::Kind::command:
    json["do"] = event.name;
    if (!event.text.empty()) json["with"] = event.text;
    return json;
  case Event::Kind::set:
    json["set"] = event.name, json["to"] = event.text;
    return json;
  case Event::Kind::wait:
    json["wait"] = true;
    return json;
  case Event::Kind::picture:
    json["picture"] = event.text;
    return json;
  }
  if (event.button != Button::left) json["button"] = button_names[static_cast<int>(event.button)];
  if (event.shift) json["shift"] = true;
  if (event.control) json["control"] = true;
  return json;
}

} // namespace

EventList parse_session(const std::string& text, const std::string& file) {
  EventList session;
  std::string where;
  try {
    const Json json = Json::parse(text);
    if (json.at("pith session") != 1) throw std::runtime_error("it is of another version");
    if (json.contains("size")) session.size = json["size"].get<std::array<int, 2>>();
    for (const int n : session.size)
      if (n < 16 || n > 16384) throw std::runtime_error("the size is not between 16 and 16384");
    for (const Json& event : json.at("events")) {
      where = ": /events/" + std::to_string(session.event.size());
      session.event.push_back(event_of(event));
    }
  } catch (const std::exception& error) {
    throw InvalidInput(file + where, error.what(), "a session is what pith view --record writes");
  }
  return session;
}

std::string session_text(const EventList& session) {
  std::string text = "{ \"pith session\": 1, \"size\": [" + std::to_string(session.size[0]) + ", " +
                     std::to_string(session.size[1]) + "],\n  \"events\": [\n";
  for (std::size_t i = 0; i < session.event.size(); ++i)
    text += "    " + json_of(session.event[i]).dump() + (i + 1 < session.event.size() ? ",\n" : "\n");
  return text + "  ] }\n";
}

} // namespace pith
