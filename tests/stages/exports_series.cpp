// Lists of exported files with their times, files of earlier runs, and a full disk.

#include "stages/series.h"
#include "tests/small_disk.h"
#include "tests/stages/export_shot.h"

using namespace firn::test;
namespace fs = std::filesystem;

TEST_CASE("the lists of a series name each file with its time, and forget what an earlier run left") {
  Folder folder;
  fs::create_directories(folder.path() / "export");
  folder.write("export/particles_0007.vtp", "old");
  folder.write("export/particles_notes.vtp", "mine");
  Strained shot("[render.background, io.particles]", folder.path());
  write_frames(shot, 2);
  CHECK(names_in(folder.path() / "export") == std::vector<std::string>{"particles.pvd", "particles.vtp.series",
                                                                       "particles_0000.vtp", "particles_0001.vtp",
                                                                       "particles_notes.vtp"});
  CHECK(bytes_of(folder.path() / "export" / "particles.vtp.series") ==
        "{\n  \"file-series-version\" : \"1.0\",\n  \"files\" : [\n    { \"name\" : \"particles_0000.vtp\", \"time\" : 0 },\n"
        "    { \"name\" : \"particles_0001.vtp\", \"time\" : 0.125 }\n  ]\n}\n");
  CHECK(bytes_of(folder.path() / "export" / "particles.pvd").find("timestep=\"0.125\" part=\"0\" file=\"particles_0001.vtp\"") !=
        std::string::npos);
}

TEST_CASE("times of a series are as short as twelve digits allow") {
  Folder folder;
  Shot shot(SceneText{}, "[render.background, io.particles]", small_image, folder.path().string());
  shot.execution().clock().time = 7000 * 1e-4;  // 0.7000000000000001
  shot.frame();
  shot.execution().finish();
  const fs::path exports = folder.path() / "export";
  CHECK(bytes_of(exports / "particles.pvd").find("timestep=\"0.7\"") != std::string::npos);
  CHECK(bytes_of(exports / "particles.vtp.series").find("\"time\" : 0.7 }") != std::string::npos);
  CHECK(bytes_of(exports / "particles_0000.vtp").find(">0.7</DataArray>") != std::string::npos);
}

TEST_CASE("a series that goes on from a later frame keeps what was before, with its times") {
  Folder folder;
  {
    Strained shot("[render.background, io.particles]", folder.path());
    write_frames(shot, 3);
  }
  Strained shot("[render.background, io.particles]", folder.path());
  shot.execution().clock().frame = 1;
  shot.execution().clock().time = 0.75;
  shot.frame();
  shot.execution().finish();
  const std::string series = bytes_of(folder.path() / "export" / "particles.vtp.series");
  CHECK(series.find("particles_0000.vtp\", \"time\" : 0 }") != std::string::npos);
  CHECK(series.find("particles_0001.vtp\", \"time\" : 0.75 }") != std::string::npos);
  CHECK(series.find("particles_0002") == std::string::npos);
  CHECK(names_in(folder.path() / "export") ==
        std::vector<std::string>{"particles.pvd", "particles.vtp.series", "particles_0000.vtp", "particles_0001.vtp"});
}

TEST_CASE("a full disk while exporting is an error that names the file, and leaves no half file") {
  Folder folder;
  Strained shot("[render.background, io.particles]", folder.path());
  std::string said = "no error";
  {
    const SmallDisk disk(1000);
    try {
      shot.frame();
      shot.execution().finish();
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
  }
  INFO(said);
  CHECK(said.find((folder.path() / "export" / "particles_0000.vtp").string()) != std::string::npos);
  CHECK(said.find("File too large") != std::string::npos);
  CHECK(names_in(folder.path() / "export").empty());
}

TEST_CASE("a disk that turns out to be full as late as when the file is closed is told, too") {
  Folder folder;
  const fs::path file = folder.path() / "file";
  std::string said = "no error";
  {
    const SmallDisk disk(100);
    try {
      firn::stages::write_file(file, std::string(200, 'x'));  // less than the C library writes at once
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
  }
  CHECK(said.find(file.string()) != std::string::npos);
  CHECK(names_in(folder.path()).empty());
}
