#include "viewer/panels.h"

#include <algorithm>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <cstring>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <utility>

namespace pith {
namespace fs = std::filesystem;

struct Panels::Parts {
  bool has_window = false;
  bool help = false;
  std::vector<Event> out;
  // the file dialog
  std::string file_command, path;
  bool open_file_dialog = false;
  // leave to lose work
  std::optional<Event> risky, after_save;
  bool open_risk = false;
  // what a crash left
  std::vector<Recovered> left;
  std::optional<Recovered> taken;
  bool open_offer = false;

  void choose(const std::string& command, const std::string& text = "") {
    out.push_back({.kind = Event::Kind::command, .name = command, .text = text});
  }
};

namespace {

/// Does it lose what is not saved?
bool risks_work(const std::string& command) { return command == "open" || command == "quit"; }

void add(std::vector<Event>& out, const std::optional<Event>& event) {
  if (event) out.push_back(*event);
}

void tip(const std::string& text) {
  if (!text.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", text.c_str());
}

ImU32 color_of(const Vec3d& c) { return ImGui::GetColorU32(ImVec4(float(c.x()), float(c.y()), float(c.z()), 0.9f)); }

} // namespace

Panels::Panels(void* window, float scale) : parts_(std::make_unique<Parts>()) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr; // the layout is ours, and nothing is written where the user stands
  ImGui::StyleColorsLight();
  ImGui::GetStyle().ScaleAllSizes(scale);
  ImGui::GetStyle().WindowRounding = 4 * scale;
  ImFontConfig font;
  font.SizePixels = 13 * scale;
  io.Fonts->AddFontDefault(&font);
  parts_->has_window = window != nullptr;
  if (window) {
    io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard; // Alt, arrows, Space, Enter: everything without a mouse
    ImGui_ImplGlfw_InitForOpenGL(static_cast<GLFWwindow*>(window), true);
  }
  ImGui_ImplOpenGL3_Init("#version 330 core");
}

Panels::~Panels() {
  ImGui_ImplOpenGL3_Shutdown();
  if (parts_->has_window) ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Panels::wants_mouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Panels::wants_keys() const {
  return ImGui::GetIO().WantTextInput || ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopup);
}
void Panels::toggle_help() { parts_->help = !parts_->help; }
const Recovered* Panels::taken_up() const { return parts_->taken ? &*parts_->taken : nullptr; }

void Panels::offer(std::vector<Recovered> left) {
  parts_->left = std::move(left);
  parts_->open_offer = !parts_->left.empty();
}

std::optional<Event> Panels::ask(const Workbench& bench, const Command& command) {
  Event event{.kind = Event::Kind::command, .name = command.name};
  if (command.name == "paste view") {
    const char* text = ImGui::GetClipboardText();
    event.text = text ? text : "";
  } else if (command.takes_text) {
    const fs::path& file = bench.document().file();
    parts_->file_command = command.name;
    parts_->path = command.name == "save as" && !file.empty() ? file.string() : fs::current_path().string() + "/";
    parts_->open_file_dialog = true;
    return {};
  } else if (risks_work(command.name) && !bench.document().empty() && bench.document().modified()) {
    parts_->risky = event;
    parts_->open_risk = true;
    return {};
  } else if (command.name == "copy view") {
    ImGui::SetClipboardText(Camera(bench.view()).text().c_str());
  }
  return event;
}

void Panels::ask_to_open(const Workbench& bench, const std::string& path) {
  const Event open{.kind = Event::Kind::command, .name = "open", .text = path};
  if (!bench.document().empty() && bench.document().modified()) {
    parts_->risky = open;
    parts_->open_risk = true;
  } else {
    parts_->out.push_back(open);
  }
}

namespace {

void menu_bar(Panels& panels, Workbench& bench, float& height, std::vector<Event>& out) {
  if (!ImGui::BeginMainMenuBar()) return;
  const auto& table = command_table();
  std::vector<std::string> menus;
  for (const Command& command : table)
    if (std::find(menus.begin(), menus.end(), command.menu) == menus.end()) menus.push_back(command.menu);
  for (const std::string& menu : menus)
    if (ImGui::BeginMenu(menu.c_str())) {
      for (const Command& command : table) {
        if (command.menu != menu) continue;
        const bool on = !command.enabled || command.enabled(bench);
        if (ImGui::MenuItem(command.label.c_str(), command.shortcut.c_str(),
                            command.name == "tool " + bench.tool_name(), on))
          add(out, panels.ask(bench, command));
        tip(command.tip);
      }
      ImGui::EndMenu();
    }
  if (ImGui::MenuItem("Help", "H")) panels.toggle_help();
  height = ImGui::GetWindowSize().y;
  ImGui::EndMainMenuBar();
}

void setting_widget(const Setting& setting, std::vector<Event>& out) {
  const auto set = [&](const std::string& text) {
    out.push_back({.kind = Event::Kind::set, .name = setting.name, .text = text});
  };
  const std::string now = setting.text();
  ImGui::PushID(setting.name.c_str());
  switch (setting.kind) {
  case Setting::Kind::toggle: {
    bool on = now == "on";
    if (ImGui::Checkbox(setting.label.c_str(), &on)) set(on ? "on" : "off");
    break;
  }
  case Setting::Kind::number: {
    float value = std::stof(now);
    const float speed = setting.high <= 1 ? 0.005f : 0.1f;
    if (ImGui::DragFloat(setting.label.c_str(), &value, speed, float(setting.low), float(setting.high), "%.3g",
                         ImGuiSliderFlags_AlwaysClamp))
      set(std::to_string(value));
    break;
  }
  case Setting::Kind::choice:
    if (ImGui::BeginCombo(setting.label.c_str(), now.c_str())) {
      for (const std::string& choice : setting.choices)
        if (ImGui::Selectable(choice.c_str(), choice == now)) set(choice);
      ImGui::EndCombo();
    }
  }
  tip(setting.tip);
  ImGui::PopID();
}

void side_panel(Panels& panels, Workbench& bench, float top, float height, std::vector<Event>& out) {
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowPos({0, top});
  ImGui::SetNextWindowSize({18 * unit, height - top});
  ImGui::Begin("Tools", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                   ImGuiWindowFlags_NoBringToFrontOnFocus);
  int column = 0;
  for (const Command& command : command_table()) {
    if (command.menu != "Tools") continue;
    if (column++ % 2) ImGui::SameLine();
    const bool chosen = command.name == "tool " + bench.tool_name();
    if (chosen) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
    if (ImGui::Button(command.label.c_str(), {8.2f * unit, 0})) add(out, panels.ask(bench, command));
    if (chosen) ImGui::PopStyleColor();
    tip(command.tip + (command.shortcut.empty() ? "" : " (" + command.shortcut + ")"));
  }
  ImGui::Separator();
  ImGui::PushItemWidth(7.5f * unit);
  for (const Setting& setting : bench.setting_list()) setting_widget(setting, out);
  ImGui::PopItemWidth();
  ImGui::Separator();
  if (!bench.document().empty()) {
    const auto button = [&](const char* name) {
      for (const Command& command : command_table())
        if (command.name == name) {
          if (ImGui::Button(command.label.c_str(), {8.2f * unit, 0})) add(out, panels.ask(bench, command));
          tip(command.tip);
        }
    };
    button("update");
    ImGui::SameLine();
    button("fill solids");
    ImGui::TextUnformatted("History");
    const auto& history = bench.document().history();
    for (std::size_t i = 0; i < history.size(); ++i)
      ImGui::TextDisabled("%s %s%s", i == bench.document().position() ? ">" : " ", history[i].label.c_str(),
                          history[i].complete() ? "" : " *");
  }
  ImGui::End();
}

void status_line(Workbench& bench, int width, int height) {
  const float unit = ImGui::GetFontSize();
  std::string line = bench.message();
  float fraction = -1;
  if (bench.document().building()) {
    const auto status = bench.document().status();
    line = "making: " + status.stage + " (Escape stops it)";
    fraction = float(status.fraction);
  } else if (line.empty() && bench.document().stale()) {
    line = "drawn strokes wait for Update (U); the last finished model shows";
  } else if (line.empty() && bench.document().empty()) {
    line = "Open a file (Ctrl+O), or drop one here: a recipe, a model or a closed surface. H shows help.";
  }
  if (line.empty()) return;
  ImGui::SetNextWindowPos({18 * unit, height - 2.2f * unit});
  ImGui::SetNextWindowSize({width - 18 * unit, 2.2f * unit});
  ImGui::Begin("Status", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs);
  if (fraction >= 0) {
    ImGui::ProgressBar(fraction, {8 * unit, 0});
    ImGui::SameLine();
  }
  if (bench.message_is_error() && line == bench.message())
    ImGui::TextColored({0.75f, 0.1f, 0.05f, 1}, "%s", line.c_str());
  else
    ImGui::TextUnformatted(line.c_str());
  ImGui::End();
}

void help_window(bool& open) {
  const float unit = ImGui::GetFontSize();
  ImGui::SetNextWindowSize({40 * unit, 34 * unit}, ImGuiCond_FirstUseEver);
  if (ImGui::Begin("Help", &open)) {
    ImGui::TextWrapped("Left drag: the tool. Right drag: turn. Shift or middle drag: pan. Wheel: zoom. Double click: "
                       "centre. F12: screenshot. Drop a file to open it.");
    if (ImGui::BeginTable("commands", 3, ImGuiTableFlags_RowBg)) {
      for (const Command& command : command_table()) {
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::Text("%s: %s", command.menu.c_str(), command.label.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(command.shortcut.c_str());
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", command.tip.c_str());
      }
      ImGui::EndTable();
    }
  }
  ImGui::End();
}

/// What the recipe holds and what is being drawn, over the picture.
void overlay(Workbench& bench, int width, int height) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  const float unit = ImGui::GetFontSize();
  const auto pixel = [&](const Vec2d& at) {
    return ImVec2(float(0.5 * width + 0.5 * height * at.x()), float(0.5 * height * (1 - at.y())));
  };
  const auto draw = [&](const std::vector<Vec2d>& line, ImU32 color, float thick) {
    std::vector<ImVec2> points;
    for (const Vec2d& p : line) points.push_back(pixel(p));
    if (points.size() == 1)
      list->AddCircleFilled(points[0], 2 * thick, color);
    else
      list->AddPolyline(points.data(), int(points.size()), color, 0, thick);
  };
  const View& view = bench.view();
  for (const WorldLine& line : bench.world_lines()) {
    std::vector<Vec2d> seen;
    for (const Vec3d& x : line.point)
      if (view.orthographic() || (x - view.eye).dot(view.forward()) > 0) seen.push_back(view.project(x));
    if (!seen.empty()) draw(seen, color_of(line.color), 0.2f * unit);
  }
  for (const auto& line : bench.tool().lines(bench)) draw(line, color_of({0.9, 0.3, 0.05}), 0.15f * unit);
}

} // namespace

std::vector<Event> Panels::build(Workbench& bench, int width, int height) {
  Parts& p = *parts_;
  ImGui_ImplOpenGL3_NewFrame();
  if (p.has_window) ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();
  io.DisplaySize = {float(width), float(height)};
  io.DisplayFramebufferScale = {1, 1};
  if (!p.has_window) io.DeltaTime = 1 / 60.0f;
  ImGui::NewFrame();
  if (const auto event = std::exchange(p.after_save, std::nullopt); event && !bench.document().modified())
    p.out.push_back(*event); // where saving failed the message says so, and nothing goes on
  overlay(bench, width, height);
  float top = 0;
  menu_bar(*this, bench, top, p.out);
  side_panel(*this, bench, top, float(height), p.out);
  status_line(bench, width, height);
  if (p.help) help_window(p.help);

  if (std::exchange(p.open_file_dialog, false)) ImGui::OpenPopup("File");
  if (ImGui::BeginPopupModal("File", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    const float unit = ImGui::GetFontSize();
    ImGui::SetNextItemWidth(36 * unit);
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##path", &p.path, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::BeginChild("list", {36 * unit, 16 * unit}, true);
    const fs::path typed = p.path;
    const fs::path folder = p.path.ends_with('/') ? typed : typed.parent_path();
    std::vector<fs::path> entries;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder, failed))
      if (!entry.path().filename().string().starts_with('.')) entries.push_back(entry.path());
    std::sort(entries.begin(), entries.end());
    if (folder.has_parent_path() && ImGui::Selectable("../", false, ImGuiSelectableFlags_DontClosePopups))
      p.path = (folder / "..").lexically_normal().string();
    for (const fs::path& entry : entries) {
      const bool is_folder = fs::is_directory(entry, failed);
      if (ImGui::Selectable((entry.filename().string() + (is_folder ? "/" : "")).c_str(), entry == typed,
                            ImGuiSelectableFlags_DontClosePopups))
        p.path = entry.string() + (is_folder ? "/" : "");
    }
    ImGui::EndChild();
    const bool overwrites = p.file_command == "save as" && fs::is_regular_file(typed, failed);
    if (overwrites) ImGui::TextColored({0.75f, 0.4f, 0, 1}, "That file exists and will be replaced.");
    if (ImGui::Button(p.file_command == "open" ? "Open" : "Save") || entered) {
      if (p.file_command == "open")
        ask_to_open(bench, p.path);
      else
        p.choose(p.file_command, p.path);
      ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (ImGui::Button("Cancel")) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  if (std::exchange(p.open_risk, false)) ImGui::OpenPopup("Unsaved changes");
  if (ImGui::BeginPopupModal("Unsaved changes", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::TextUnformatted("The document has changes that are not saved.");
    const bool has_file = !bench.document().file().empty();
    if (has_file && ImGui::Button("Save, then go on")) {
      p.choose("save");
      p.after_save = p.risky;
      ImGui::CloseCurrentPopup();
    }
    if (has_file) ImGui::SameLine();
    if (ImGui::Button("Go on without them")) {
      p.out.push_back(*p.risky);
      ImGui::CloseCurrentPopup();
    }
    ImGui::SameLine();
    if (ImGui::Button("Stay")) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
  }
  if (std::exchange(p.open_offer, false)) ImGui::OpenPopup("Work was left behind");
  if (ImGui::BeginPopupModal("Work was left behind", nullptr, ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::TextUnformatted("pith ended without saving this work. Take it up again?");
    for (const Recovered& left : p.left)
      if (ImGui::Button((left.file.empty() ? left.folder.string() + " (never saved)" : left.file.string()).c_str())) {
        p.taken = left;
        ImGui::CloseCurrentPopup();
      }
    if (ImGui::Button("Not now")) ImGui::CloseCurrentPopup();
    tip("it is offered again at the next start");
    ImGui::EndPopup();
  }
  ImGui::Render();
  return std::exchange(p.out, {});
}

void Panels::draw() { ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData()); }

} // namespace pith
