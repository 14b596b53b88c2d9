#pragma once
// The document of a window: a recipe, its history, and the model that belongs to it (docs/design.md, decision 3).
#include "recipe/steps.h"
#include "viewer/background_build.h"
#include "viewer/recovery.h"

namespace pith {

/// A model made ready for drawing and cutting; shared by all states of the history that differ in cuts alone.
struct ReadyRoot {
  explicit ReadyRoot(Model model);
  Root root;
  PerFacet<std::array<Vec3f, 3>> skin_normal; ///< facet_corner_normals
  Cutter cutter;
  std::map<std::string, std::string> keys; ///< of the stages that the model comes from
};

/// One entry of the history.
struct DocumentState {
  std::string label; ///< what was done: "cut", "move" …
  Recipe recipe;
  std::shared_ptr<ReadyRoot> root; ///< null: not built, or no longer kept
  std::shared_ptr<const Pieces> pieces;
  std::map<std::string, std::string> keys; ///< of all stages, as a .pith file stores them
  bool complete() const { return root && pieces; }
};

struct DocumentOptions {
  BuildOptions build;
  std::filesystem::path recovery;             ///< folder; empty: none
  std::uint64_t pieces_bytes = 1'000'000'000; ///< of pieces kept for undo; beyond it the farthest are rebuilt
};

/// Every edit is one entry of the history. Cuts and moves are done at once; everything else is built in the
/// background, and until it is there the last complete state shows (`stale`). Used from one thread.
class Document {
public:
  explicit Document(DocumentOptions options = {});

  /// A recipe (.json), a model (.pith) or a bare surface, which becomes a recipe of its own. The history starts anew.
  /// Errors: as the readers'; the document is unchanged then.
  void open(const std::filesystem::path& path);
  /// Takes up what a crash left.
  void open(const Recovered& recovered);

  /// Writes the recipe (.json) or, with its model, a .pith; by extension. Paths in the recipe are made relative to
  /// the new folder. Errors: IoFailure, InvalidInput for other extensions or a model that is not complete; nothing is
  /// lost then.
  void save(const std::filesystem::path& path);

  bool empty() const { return history_.empty(); }
  const std::filesystem::path& file() const { return file_; } ///< empty: never saved
  const std::filesystem::path& folder() const { return folder_; }
  bool modified() const { return at_ != saved_at_; }

  const Recipe& recipe() const { return history_[at_].recipe; } ///< as edited last
  /// What to show: the current state, or the last complete one. Null before anything was built.
  const DocumentState* shown() const { return shown_ ? &*shown_ : nullptr; }
  bool stale() const { return !empty() && !history_[at_].complete(); }
  std::uint64_t opened() const { return opened_; }   ///< how often something was opened
  std::uint64_t version() const { return version_; } ///< another number whenever what is shown has changed

  /// Done at once. Errors: as apply_cut and apply_move; InvalidInput while the state is stale. The document is
  /// unchanged then.
  CutResult cut(CutStep step);
  void move(MoveStep step);
  /// What a cut would leave, without an edit; halves that do not hang together are one piece yet. Errors as cut().
  Pieces preview(const CutStep& step) const;

  /// Any other edit. Built at once in the background, or when update() is called.
  enum class Build { now, later };
  void edit(Recipe recipe, std::string label, Build build = Build::now);
  void update();

  bool can_undo() const { return at_ > 0; }
  bool can_redo() const { return at_ + 1 < history_.size(); }
  void undo();
  void redo();
  std::size_t position() const { return at_; }
  const std::vector<DocumentState>& history() const { return history_; }

  /// Takes what the background has finished. Returns its error message, if there was one.
  std::string poll();
  bool building() const { return build_.busy(); }
  BackgroundBuild::Status status() const { return build_.status(); }
  void cancel() { build_.cancel(); }
  /// Blocks until the background is done, then polls.
  std::string wait();

private:
  void begin(Recipe recipe, std::filesystem::path file, std::filesystem::path folder);
  void push(DocumentState state);
  void show(std::size_t at);
  void require_complete(const char* what) const;
  DocumentState after(std::string label) const;
  void keep_recovery();
  void keep_budget();

  DocumentOptions options_;
  BackgroundBuild build_;
  RecoveryFile recovery_;
  std::filesystem::path file_, folder_;
  std::vector<DocumentState> history_;
  std::optional<DocumentState> shown_;
  std::size_t at_ = 0, saved_at_ = 0;
  std::uint64_t version_ = 0, opened_ = 0, serial_ = 0; ///< serial: tickets of builds
  std::map<std::uint64_t, std::size_t> ticket_;
};

} // namespace pith
