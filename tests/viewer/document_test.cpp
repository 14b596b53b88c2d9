// The document: history, builds in the background, saving, recovery.
#include "recipe/recipe_paths.h"
#include "tests/support/scratch.h"
#include "viewer/document.h"
#include "volume/base/error.h"
#include "volume/io/atomic_file.h"
#include "volume/io/model_io.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace pith {
namespace {

namespace fs = std::filesystem;

const fs::path recipes = fs::path(PITH_SOURCE_DIR) / "data/recipes/table1";

CutStep plane(const Vec3d& normal, double offset) {
  CutStep step;
  step.shape = PlaneCut{.normal = normal, .offset = offset};
  return step;
}

/// The model file of a state, byte for byte.
std::string bytes_of(const DocumentState& state, const fs::path& folder) {
  const fs::path path = folder / "state.pith";
  write_model(path, state.root->root.model(), *state.pieces, recipe_text(state.recipe), state.keys);
  return file_content(path);
}

class Documents : public ::testing::Test {
protected:
  testing::ScratchFolder scratch;
  DocumentOptions options;
  void SetUp() override {
    options.build.cache = scratch.path() / "cache";
    options.recovery = scratch.path() / "recovery";
  }
};

TEST_F(Documents, UndoAllRedoAllIsTheModelOfABuild) {
  Document document(options);
  document.open(recipes / "kiwi.json");
  EXPECT_TRUE(document.stale());
  ASSERT_EQ(document.wait(), "");
  ASSERT_FALSE(document.stale());
  Recipe bare = document.recipe();
  bare.cuts.clear();
  bare.moves.clear();
  document.edit(bare, "clear");
  ASSERT_EQ(document.wait(), "");
  document.cut(plane({0, 0, 1}, 0));
  MoveStep move;
  move.piece = rest_point_in(*document.shown()->pieces, 1, document.shown()->root->root.model().mesh);
  move.translate = {0, 0, 8};
  move.angle = 0.3;
  document.move(move);
  document.cut(plane({1, 0.2, 0}, 1));
  ASSERT_EQ(document.shown()->pieces->piece.size(), 4u);
  const std::string last = bytes_of(*document.shown(), scratch.path());
  EXPECT_TRUE(document.modified());

  const std::size_t end = document.position();
  while (document.can_undo()) document.undo();
  EXPECT_FALSE(document.modified());
  EXPECT_EQ(document.position(), 0u);
  while (document.can_redo()) document.redo();
  EXPECT_EQ(document.position(), end);
  EXPECT_EQ(bytes_of(*document.shown(), scratch.path()), last);

  // By hand and by a build: the same bytes.
  Builder builder;
  const BuildResult built = builder.build(document.recipe(), document.folder());
  write_model(scratch.path() / "built.pith", built.model, built.pieces, recipe_text(document.recipe()), built.keys());
  EXPECT_EQ(file_content(scratch.path() / "built.pith"), last);
}

TEST_F(Documents, AfterMovesTheKeysAreThoseOfABuild) {
  Document document(options);
  document.open(recipes / "kiwi.json");
  ASSERT_EQ(document.wait(), "");
  MoveStep explode, drop;
  explode.explode = 0.5;
  drop.drop = -3;
  document.move(explode);
  document.cut(plane({0.1, 1, 0}, 0));
  document.move(drop);
  document.move(explode);
  Builder builder;
  const BuildResult built = builder.build(document.recipe(), document.folder());
  EXPECT_EQ(document.shown()->keys, built.keys());
  write_model(scratch.path() / "built.pith", built.model, built.pieces, recipe_text(document.recipe()), built.keys());
  EXPECT_TRUE(file_content(scratch.path() / "built.pith") == bytes_of(*document.shown(), scratch.path()));
}

TEST_F(Documents, AFailedEditChangesNothing) {
  Document document(options);
  document.open(recipes / "kiwi.json");
  EXPECT_THROW(document.cut(plane({0, 0, 1}, 0)), InvalidInput); // not built yet
  ASSERT_EQ(document.wait(), "");
  const std::size_t at = document.position();
  EXPECT_THROW(document.cut(plane({0, 0, 1}, 1e6)), InvalidInput);
  EXPECT_THROW(document.open(scratch.path() / "picture.png"), InvalidInput);
  write_file(scratch.path() / "broken.json", "{ \"pith\": 1, ");
  EXPECT_THROW(document.open(scratch.path() / "broken.json"), InvalidInput);
  EXPECT_THROW(document.save(scratch.path() / "absent" / "x.json"), IoFailure);
  EXPECT_EQ(document.position(), at);
  EXPECT_FALSE(document.stale());

  // A recipe that cannot be built says why; the model before it still shows, and undo leads back to it.
  Recipe recipe = document.recipe();
  recipe.solids[0].region = 7;
  document.edit(recipe, "region");
  EXPECT_NE(document.wait().find("/solids/0/region"), std::string::npos);
  EXPECT_TRUE(document.stale());
  ASSERT_NE(document.shown(), nullptr);
  document.undo();
  EXPECT_FALSE(document.stale());
}

TEST_F(Documents, SavedElsewhereItNamesTheSameFiles) {
  fs::create_directories(scratch.path() / "deep/down");
  Document document(options);
  document.open(recipes / "kiwi.json");
  ASSERT_EQ(document.wait(), "");
  for (const char* name : {"deep/down/copy.json", "copy.pith"}) {
    document.save(scratch.path() / name);
    EXPECT_FALSE(document.modified());
    Document again(options);
    again.open(scratch.path() / name);
    ASSERT_EQ(again.wait(), "") << name;
    EXPECT_FALSE(again.stale());
    EXPECT_EQ(recipe_text(again.recipe()), recipe_text(document.recipe()));
    Recipe recipe = again.recipe();
    EXPECT_TRUE(fs::exists(again.folder() / recipe.surface.file)) << recipe.surface.file;
  }
}

TEST_F(Documents, KilledWorkIsOfferedBack) {
  std::string expected;
  {
    Document document(options);
    document.open(recipes / "kiwi.json");
    ASSERT_EQ(document.wait(), "");
    document.cut(plane({0, 0, 1}, 2));
    expected = recipe_text(document.recipe());
    EXPECT_TRUE(recoverable(options.recovery).empty()); // its owner is alive
    // Closed in order: nothing is left.
  }
  EXPECT_TRUE(recoverable(options.recovery).empty());
  const pid_t child = ::fork();
  if (child == 0) {
    RecoveryFile file(options.recovery);
    file.keep(recipes / "kiwi.json", recipes, expected);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  const std::vector<Recovered> left = recoverable(options.recovery);
  ASSERT_EQ(left.size(), 1u);
  Document document(options);
  document.open(left[0]);
  EXPECT_TRUE(document.modified());
  ASSERT_EQ(document.wait(), "");
  EXPECT_EQ(recipe_text(document.recipe()), expected);
  EXPECT_TRUE(recoverable(options.recovery).empty()); // it is this document's now
  const fs::directory_iterator files(options.recovery);
  EXPECT_EQ(std::distance(begin(files), end(files)), 2); // its own file and lock, nothing of the dead one's
}

} // namespace
} // namespace pith
