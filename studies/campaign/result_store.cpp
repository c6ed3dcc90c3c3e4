#include "studies/campaign/result_store.h"

#include <sqlite3.h>

#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"

namespace understudy::studies {
namespace fs = std::filesystem;
namespace {

constexpr int kApplication = 0x554e4453;  // "UNDS", what `file` and we know the file by
constexpr int kPatience = 5000;           // [ms], for another process that is about to end
constexpr const char* kFixedColumns = "run,scenario,seed,status,error,command,summary_sha256,seconds";
constexpr int kFixed = 8;

[[noreturn]] void fail(const fs::path& path, sqlite3* database, int code) {
  const std::string why = database ? sqlite3_errmsg(database) : sqlite3_errstr(code);
  switch (code & 0xff) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw InputError(fmt::format("{}: another campaign is writing this result store", path.string()));
    case SQLITE_NOTADB:
    case SQLITE_CORRUPT:
      throw InputError(fmt::format("{}: not a result store that can be read: {}; begin in another folder",
                                   path.string(), why));
    case SQLITE_CANTOPEN:
      throw InputError(fmt::format("{}: cannot open this result store: {}", path.string(), why));
    default:
      throw MachineError(fmt::format("{}: {}", path.string(), why));
  }
}

std::string column(const std::string& name) {
  std::string quoted = "\"";
  for (const char c : name) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::vector<std::string> value_columns(const StoreHeader& header) {
  std::vector<std::string> columns;
  for (const std::string& key : header.parameters) columns.push_back(column(key));
  for (const std::string& name : row_metrics()) columns.push_back(column(name));
  return columns;
}

/// A compiled statement.
class Statement {
 public:
  Statement(const fs::path& path, sqlite3* database, const std::string& sql)
      : path_(path), database_(database) {
    if (const int code = sqlite3_prepare_v2(database, sql.c_str(), -1, &statement_, nullptr);
        code != SQLITE_OK)
      fail(path, database, code == SQLITE_ERROR ? SQLITE_CORRUPT : code);  // a table or column is not there
  }
  ~Statement() { sqlite3_finalize(statement_); }
  Statement(const Statement&) = delete;
  Statement& operator=(const Statement&) = delete;

  /// A row has come.
  bool step() {
    const int code = sqlite3_step(statement_);
    if (code != SQLITE_ROW && code != SQLITE_DONE) fail(path_, database_, code);
    return code == SQLITE_ROW;
  }
  void reset() {
    sqlite3_reset(statement_);
    sqlite3_clear_bindings(statement_);
    next_ = 1;
  }
  void bind(std::uint64_t value) {
    sqlite3_bind_int64(statement_, next_++, static_cast<sqlite3_int64>(value));
  }
  void bind(double value) { sqlite3_bind_double(statement_, next_++, value); }
  void bind(const std::string& text) {
    sqlite3_bind_text(statement_, next_++, text.c_str(), static_cast<int>(text.size()), SQLITE_TRANSIENT);
  }
  void bind_null() { ++next_; }
  std::uint64_t integer(int i) const {
    return static_cast<std::uint64_t>(sqlite3_column_int64(statement_, i));
  }
  double number(int i) const { return sqlite3_column_double(statement_, i); }
  bool null(int i) const { return sqlite3_column_type(statement_, i) == SQLITE_NULL; }
  std::string text(int i) const {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(statement_, i));
    return bytes ? std::string(bytes, static_cast<std::size_t>(sqlite3_column_bytes(statement_, i)))
                 : std::string();
  }

 private:
  const fs::path& path_;
  sqlite3* database_;
  sqlite3_stmt* statement_ = nullptr;
  int next_ = 1;
};

/// An open file.
class Database {
 public:
  Database(fs::path path, int flags, int patience = kPatience) : path_(std::move(path)) {
    const int code = sqlite3_open_v2(path_.c_str(), &database_, flags, nullptr);
    if (code != SQLITE_OK) {
      sqlite3_close(database_);
      fail(path_, nullptr, code);
    }
    sqlite3_busy_timeout(database_, patience);
    // Of a file that comes from a stranger, rows are read, and no queries of its own run.
    sqlite3_db_config(database_, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
    sqlite3_db_config(database_, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  }
  ~Database() { sqlite3_close(database_); }
  Database(const Database&) = delete;
  Database& operator=(const Database&) = delete;

  void run(const std::string& sql) {
    if (const int code = sqlite3_exec(database_, sql.c_str(), nullptr, nullptr, nullptr); code != SQLITE_OK)
      fail(path_, database_, code);
  }
  Statement prepare(const std::string& sql) { return {path_, database_, sql}; }
  std::uint64_t pragma(const char* name) {
    Statement statement(path_, database_, fmt::format("PRAGMA {}", name));
    return statement.step() ? statement.integer(0) : 0;
  }
  const fs::path& path() const { return path_; }
  sqlite3* handle() { return database_; }

 private:
  fs::path path_;
  sqlite3* database_ = nullptr;
};

void create(Database& database, const StoreHeader& header) {
  database.run("BEGIN EXCLUSIVE");
  database.run(
      "CREATE TABLE campaign(name TEXT NOT NULL, inputs_sha256 TEXT NOT NULL, version TEXT NOT NULL);"
      "CREATE TABLE parameters(position INTEGER PRIMARY KEY, key TEXT NOT NULL)");
  std::string table =
      "CREATE TABLE runs(run INTEGER PRIMARY KEY, scenario TEXT NOT NULL, seed INTEGER NOT NULL, status TEXT "
      "NOT "
      "NULL, error TEXT, command TEXT NOT NULL, summary_sha256 TEXT, seconds REAL NOT NULL";
  for (const std::string& key : header.parameters)
    table += fmt::format(", {} NUMERIC", column(key));  // words stay words
  for (const std::string& name : row_metrics()) table += fmt::format(", {} REAL", column(name));
  database.run(table + ")");
  for (const char* change : {"UPDATE", "DELETE"})
    database.run(
        fmt::format("CREATE TRIGGER no_{0} BEFORE {0} ON runs BEGIN SELECT RAISE(ABORT, 'a result store "
                    "is append-only'); END",
                    change));
  {
    Statement insert = database.prepare("INSERT INTO campaign VALUES(?, ?, ?)");
    for (const std::string& word : {header.campaign, header.inputs_sha256, header.version}) insert.bind(word);
    insert.step();
  }
  Statement insert = database.prepare("INSERT INTO parameters VALUES(?, ?)");
  for (std::size_t i = 0; i < header.parameters.size(); ++i) {
    insert.reset();
    insert.bind(std::uint64_t{i});
    insert.bind(header.parameters[i]);
    insert.step();
  }
  database.run(fmt::format("PRAGMA application_id = {}; PRAGMA user_version = {}; COMMIT", kApplication,
                           kStoreVersion));
}

bool is_empty(Database& database) {
  return database.pragma("application_id") == 0 && database.pragma("schema_version") == 0;
}

StoreHeader header_of(Database& database) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}", database.path().string(), why));
  };
  if (database.pragma("application_id") != kApplication) refuse("not the result store of a campaign");
  if (const auto version = database.pragma("user_version"); version != kStoreVersion)
    refuse(fmt::format("a result store of schema version {}; this program reads version {}", version,
                       kStoreVersion));
  StoreHeader header;
  {
    Statement select = database.prepare("SELECT name, inputs_sha256, version FROM campaign");
    if (!select.step()) refuse("the result store does not say of which campaign");
    header.campaign = select.text(0);
    header.inputs_sha256 = select.text(1);
    header.version = select.text(2);
  }
  Statement select = database.prepare("SELECT key FROM parameters ORDER BY position");
  while (select.step()) header.parameters.push_back(select.text(0));
  return header;
}

void check_header(const fs::path& path, const StoreHeader& found, const StoreHeader& wanted) {
  const auto refuse = [&](const std::string& why) {
    throw InputError(fmt::format("{}: {}", path.string(), why));
  };
  if (found.version != wanted.version)
    refuse(fmt::format("runs of understudy {}; this is {}: go on with that one, or begin in another folder",
                       found.version, wanted.version));
  if (found.campaign != wanted.campaign)
    refuse(fmt::format("runs of the campaign '{}', not of '{}'", found.campaign, wanted.campaign));
  if (found.inputs_sha256 != wanted.inputs_sha256 || found.parameters != wanted.parameters)
    refuse(
        "the campaign or one of its inputs (scenarios, machines, programs, fixtures, materials) was changed "
        "since: begin in another folder");
}

/// A file that its writer has left behind has a log, which reading takes in: it needs to be written.
Database open_existing(const fs::path& path) { return {path, SQLITE_OPEN_READWRITE}; }

RunEnd end_of(const Statement& select, const fs::path& path) {
  try {
    return run_end(select.text(3));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: run {} is damaged: {}; begin in another folder", path.string(),
                                 select.integer(0), error.what()));
  }
}

RunRow row_of(const Statement& select, const fs::path& path, std::size_t parameters) {
  RunRow row;
  row.index = select.integer(0);
  row.scenario = select.text(1);
  row.seed = select.integer(2);
  row.end = end_of(select, path);
  row.error = select.text(4);
  row.command = select.text(5);
  row.summary_sha256 = select.text(6);
  row.seconds = select.number(7);
  int at = kFixed;
  for (std::size_t i = 0; i < parameters; ++i) row.values.push_back(select.text(at++));
  for (const std::string& name : row_metrics()) {
    if (!select.null(at)) row.metrics[name] = select.number(at);
    ++at;
  }
  return row;
}

void bind_text_or_null(Statement& statement, const std::string& text) {
  if (text.empty())
    statement.bind_null();
  else
    statement.bind(text);
}

void bind_row(Statement& insert, const RunRow& row) {
  insert.reset();
  insert.bind(row.index);
  insert.bind(row.scenario);
  insert.bind(row.seed);
  insert.bind(std::string(to_string(row.end)));
  bind_text_or_null(insert, row.error);
  insert.bind(row.command);
  bind_text_or_null(insert, row.summary_sha256);
  insert.bind(row.seconds);
  for (const std::string& value : row.values) insert.bind(value);
  for (const std::string& name : row_metrics()) {
    const auto found = row.metrics.find(name);
    if (found == row.metrics.end())
      insert.bind_null();
    else
      insert.bind(std::get<double>(found->second));
  }
}

std::string insert_text(const StoreHeader& header) {
  std::vector<std::string> columns = value_columns(header);
  const std::vector<std::string> places(kFixed + columns.size(), "?");
  return fmt::format("INSERT OR IGNORE INTO runs({}, {}) VALUES({})", kFixedColumns, fmt::join(columns, ", "),
                     fmt::join(places, ", "));
}

}  // namespace

struct ResultStore::Connection {
  Connection(const fs::path& path, const StoreHeader& header, StoreUse use)
      : database(path, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE) {
    // While its one process holds the lock, a log needs no memory that processes share, which network file
    // systems have not.
    if (use == StoreUse::part) database.run("PRAGMA locking_mode = EXCLUSIVE; PRAGMA journal_mode = WAL");
    database.run("PRAGMA synchronous = FULL");
    if (is_empty(database))
      create(database, header);
    else
      check_header(path, header_of(database), header);
    if (use == StoreUse::part) database.run("BEGIN EXCLUSIVE; COMMIT");  // from here on the lock is held
    insert = std::make_unique<Statement>(database.path(), database.handle(), insert_text(header));
  }

  Database database;
  std::unique_ptr<Statement> insert;
};

ResultStore::ResultStore(const fs::path& path, const StoreHeader& header, StoreUse use)
    : connection_(std::make_unique<Connection>(path, header, use)) {}
ResultStore::~ResultStore() = default;
ResultStore::ResultStore(ResultStore&&) noexcept = default;
ResultStore& ResultStore::operator=(ResultStore&&) noexcept = default;

void ResultStore::add(const RunRow& row) {
  bind_row(*connection_->insert, row);
  connection_->insert->step();
  connection_->insert->reset();
}

void ResultStore::add_all(const std::vector<RunRow>& rows) {
  connection_->database.run("BEGIN IMMEDIATE");
  for (const RunRow& row : rows) add(row);
  connection_->database.run("COMMIT");
}

std::set<std::uint64_t> stored_runs(const fs::path& path, const StoreHeader& header) {
  Database database = open_existing(path);
  if (is_empty(database)) return {};  // its writer died before the first row
  check_header(path, header_of(database), header);
  std::set<std::uint64_t> runs;
  Statement select = database.prepare("SELECT run FROM runs");
  while (select.step()) runs.insert(select.integer(0));
  return runs;
}

std::vector<RunRow> read_rows(const fs::path& path, const StoreHeader& header, std::uint64_t begin,
                              std::uint64_t end) {
  Database database = open_existing(path);
  if (is_empty(database)) return {};
  check_header(path, header_of(database), header);
  Statement select =
      database.prepare(fmt::format("SELECT {}, {} FROM runs WHERE run >= {} AND run < {} ORDER BY run",
                                   kFixedColumns, fmt::join(value_columns(header), ", "), begin, end));
  std::vector<RunRow> rows;
  while (select.step()) rows.push_back(row_of(select, path, header.parameters.size()));
  return rows;
}

bool being_written(const fs::path& path) {
  try {
    Database database(path, SQLITE_OPEN_READWRITE, 0);
    static_cast<void>(is_empty(database));
    return false;
  } catch (const InputError&) {
    return true;
  }
}

std::optional<StoreHeader> read_header(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return std::nullopt;
  Database database = open_existing(path);
  return header_of(database);
}

}  // namespace understudy::studies
