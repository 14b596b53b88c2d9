#include "viewer/document.h"

#include "raytrace/scene_surface.h"
#include "recipe/recipe_paths.h"
#include "recipe/stage_codec.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/model_io.h"

#include <algorithm>

namespace pith {
namespace fs = std::filesystem;
namespace {

constexpr double crease = 0.6; ///< radians: skin that turns by more is drawn with an edge
constexpr std::size_t nowhere = static_cast<std::size_t>(-1);

std::string extension(const fs::path& path) {
  std::string text = path.extension().string();
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

/// The keys that say what the model is: all but those of cuts and moves.
std::map<std::string, std::string> root_keys(const std::map<std::string, std::string>& keys) {
  std::map<std::string, std::string> result;
  for (const auto& [stage, key] : keys)
    if (!stage.starts_with("cut ") && !stage.starts_with("move ")) result[stage] = key;
  return result;
}

std::uint64_t bytes_of(const Pieces& pieces) {
  ArchiveCounter counter;
  transfer(counter, pieces);
  return counter.bytes;
}

} // namespace

ReadyRoot::ReadyRoot(Model model)
    : root(std::move(model)), skin_normal(facet_corner_normals(root.model().mesh, root.model().boundary, crease)),
      cutter(root.model().mesh, root.model().boundary) {}

Document::Document(DocumentOptions options)
    : options_(std::move(options)), build_(options_.build), recovery_(options_.recovery) {}

void Document::begin(Recipe recipe, fs::path file, fs::path folder) {
  build_.cancel();
  recovery_.forget();
  history_.clear();
  shown_.reset();
  ticket_.clear();
  file_ = std::move(file);
  folder_ = std::move(folder);
  at_ = saved_at_ = 0;
  ++version_;
  ++opened_;
  DocumentState first;
  first.label = "open";
  first.recipe = std::move(recipe);
  history_.push_back(std::move(first));
}

void Document::open(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const std::string kind = extension(path);
  if (kind == ".json") {
    begin(read_recipe(absolute), absolute, absolute.parent_path());
    update();
  } else if (kind == ".pith") {
    ModelFile file = read_model(absolute);
    Recipe recipe = parse_recipe(file.recipe, absolute.filename().string());
    begin(std::move(recipe), absolute, absolute.parent_path());
    DocumentState& state = history_[0];
    state.root = std::make_shared<ReadyRoot>(std::move(file.model));
    state.root->keys = root_keys(file.key);
    state.pieces = std::make_shared<const Pieces>(std::move(file.pieces));
    state.keys = std::move(file.key);
    show(0);
  } else if (kind == ".obj" || kind == ".off" || kind == ".ply" || kind == ".stl") {
    Recipe recipe;
    recipe.name = absolute.stem().string();
    recipe.surface.file = absolute.filename().string();
    begin(std::move(recipe), {}, absolute.parent_path());
    update();
  } else {
    throw InvalidInput(path.filename().string(), "is nothing that pith opens",
                       "open a recipe (.json), a model (.pith) or a surface (.obj, .off, .ply, .stl)");
  }
}

void Document::open(const Recovered& recovered) {
  begin(parse_recipe(recovered.recipe, recovered.file.empty() ? "recovered" : recovered.file.filename().string()),
        recovered.file, recovered.folder);
  saved_at_ = nowhere;
  keep_recovery();
  std::error_code ignored;
  fs::remove(recovered.path, ignored);
  fs::remove(fs::path(recovered.path).replace_extension(".lock"), ignored);
  update();
}

void Document::save(const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  const Recipe recipe = rebased(this->recipe(), folder_, absolute.parent_path());
  if (extension(path) == ".json") {
    write_file(absolute, recipe_text(recipe));
  } else if (extension(path) == ".pith") {
    require_complete("save a model");
    const DocumentState& state = history_[at_];
    write_model(absolute, state.root->root.model(), *state.pieces, recipe_text(recipe), state.keys);
  } else {
    throw InvalidInput(path.filename().string(), "is neither a recipe nor a model", "save as .json or .pith");
  }
  for (DocumentState& state : history_) state.recipe = rebased(state.recipe, folder_, absolute.parent_path());
  file_ = absolute;
  folder_ = absolute.parent_path();
  saved_at_ = at_;
  recovery_.forget();
}

void Document::require_complete(const char* what) const {
  if (empty()) throw InvalidInput("document", "there is nothing open", "open a file first");
  if (stale())
    throw InvalidInput(what, "the model is not made yet",
                       building() ? "wait until it is ready" : "press Update (U) first");
}

Pieces Document::preview(const CutStep& step) const {
  require_complete("cut");
  const DocumentState& state = history_[at_];
  Pieces pieces = *state.pieces;
  const Root& root = state.root->root;
  apply_cut(pieces, {root.model(), root.locator(), folder_, &state.root->cutter, false}, step, "cut");
  return pieces;
}

/// The next state of the history, so far the same.
DocumentState Document::after(std::string label) const {
  require_complete(label.c_str());
  DocumentState state = history_[at_];
  state.label = std::move(label);
  return state;
}

CutResult Document::cut(CutStep step) {
  DocumentState state = after(step.join.empty() ? "cut" : "join");
  const Root& root = state.root->root;
  append_cut(state.recipe, std::move(step), *state.pieces, root.model().mesh);
  Pieces pieces = *state.pieces;
  // As the recipe has it, placements included: what a build does.
  CutResult result = apply_cut(pieces, {root.model(), root.locator(), folder_, &state.root->cutter},
                               state.recipe.cuts.back(), "cut");
  state.pieces = std::make_shared<const Pieces>(std::move(pieces));
  add_last_cut(state.keys, state.recipe);
  push(std::move(state));
  return result;
}

void Document::move(MoveStep step) {
  DocumentState state = after(step.explode ? "explode" : step.drop ? "drop" : "move");
  const Root& root = state.root->root;
  Pieces pieces = *state.pieces;
  apply_move(pieces, root.model().mesh, root.locator(), step, "move");
  state.pieces = std::make_shared<const Pieces>(std::move(pieces));
  state.recipe.moves.push_back(std::move(step));
  add_last_move(state.keys, state.recipe);
  push(std::move(state));
}

void Document::edit(Recipe recipe, std::string label, Build build) {
  if (empty()) throw InvalidInput("document", "there is nothing open", "open a file first");
  DocumentState state;
  state.label = std::move(label);
  state.recipe = std::move(recipe);
  push(std::move(state));
  if (build == Build::now) update();
}

void Document::push(DocumentState state) {
  if (saved_at_ > at_ && saved_at_ != nowhere) saved_at_ = nowhere; // that state can be reached no more
  history_.resize(at_ + 1);
  std::erase_if(ticket_, [&](const auto& t) { return t.second > at_; });
  history_.push_back(std::move(state));
  show(history_.size() - 1);
  keep_recovery();
  keep_budget();
}

void Document::show(std::size_t at) {
  at_ = at;
  ++version_;
  if (history_[at].complete()) shown_ = history_[at];
}

void Document::update() {
  if (empty() || history_[at_].complete()) return;
  const std::uint64_t ticket = ++serial_;
  ticket_[ticket] = at_;
  build_.start(ticket, history_[at_].recipe, folder_);
}

void Document::undo() {
  if (!can_undo()) return;
  show(at_ - 1);
  keep_recovery();
}

void Document::redo() {
  if (!can_redo()) return;
  show(at_ + 1);
  keep_recovery();
}

std::string Document::poll() {
  std::optional<BackgroundBuild::Outcome> outcome = build_.take();
  if (!outcome) return {};
  const auto ticket = ticket_.find(outcome->ticket);
  if (ticket == ticket_.end()) return {};
  const std::size_t entry = ticket->second;
  ticket_.erase(ticket);
  if (!outcome->error.empty()) return outcome->error;
  if (!outcome->result || entry >= history_.size()) return {};
  DocumentState& state = history_[entry];
  state.keys = outcome->result->keys();
  const auto keys = root_keys(state.keys);
  for (const DocumentState& other : history_)
    if (other.root && other.root->keys == keys) state.root = other.root;
  if (!state.root) {
    state.root = std::make_shared<ReadyRoot>(std::move(outcome->result->model));
    state.root->keys = keys;
  }
  state.pieces = std::make_shared<const Pieces>(std::move(outcome->result->pieces));
  if (entry == at_) show(at_);
  keep_budget();
  return {};
}

std::string Document::wait() {
  build_.wait();
  return poll();
}

void Document::keep_recovery() {
  if (modified())
    recovery_.keep(file_, folder_, recipe_text(recipe()));
  else
    recovery_.forget();
}

void Document::keep_budget() {
  std::uint64_t bytes = 0;
  for (std::size_t reach = 0; reach < history_.size(); ++reach) // from the current state outwards
    for (const bool back : {true, false}) {
      if (reach == 0 && !back) continue;
      if (back ? reach > at_ : at_ + reach >= history_.size()) continue;
      DocumentState& state = history_[back ? at_ - reach : at_ + reach];
      if (!state.pieces) continue;
      bytes += bytes_of(*state.pieces);
      if (bytes > options_.pieces_bytes && reach > 0) {
        state.pieces.reset();
        state.root.reset();
      }
    }
}

} // namespace pith
