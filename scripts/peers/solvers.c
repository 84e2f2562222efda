/* Times one sparse direct solver on one matrix: PARDISO of MKL, CHOLMOD, or MUMPS.
 *
 *   cc -O2 -DUSE_PARDISO|-DUSE_CHOLMOD|-DUSE_MUMPS scripts/peers/solvers.c -o PROGRAM [libraries] -lm
 *   PROGRAM MATRIX_DIR THREADS
 *
 * MATRIX_DIR holds size.txt, starts.i64, rows.i32 and values.f64: the lower triangle of a symmetric positive definite
 * matrix by columns, counted from 0, as `cargo bench -p raceway-solver --bench peers -- export` writes it. Prints one
 * line of `name value` pairs as that benchmark does for our own solvers: least processor and wall seconds of several
 * runs, bytes of the factor, peak memory, and the error of the solution of S x = b with a known x.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define BLOCK 36

typedef struct { int n; int64_t entries, *starts; int32_t *rows; double *values; } Matrix;
typedef struct { double cpu, wall; } Time;

static void fail(const char *what) { fprintf(stderr, "solvers: %s\n", what); exit(2); }

static void *read_all(const char *dir, const char *name, size_t bytes) {
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", dir, name);
    FILE *file = fopen(path, "rb");
    void *data = malloc(bytes);
    if (!file || !data || fread(data, 1, bytes, file) != bytes) fail(path);
    fclose(file);
    return data;
}

static Matrix read_matrix(const char *dir) {
    char path[4096];
    long n, entries;
    snprintf(path, sizeof path, "%s/size.txt", dir);
    FILE *file = fopen(path, "r");
    if (!file || fscanf(file, "%ld %ld", &n, &entries) != 2) fail(path);
    fclose(file);
    Matrix m = { (int)n, entries, read_all(dir, "starts.i64", (n + 1) * 8), read_all(dir, "rows.i32", entries * 4),
                 read_all(dir, "values.f64", entries * 8) };
    return m;
}

/* The known solution: no two neighbours alike, between -1 and 1. */
static double known(int row) { return ((row % 1009) / 504.0 - 1.0) * (row % 2 == 0 ? 1.0 : -0.5); }

static double *right_side(const Matrix *m) {
    double *b = calloc(m->n, sizeof *b);
    for (int j = 0; j < m->n; j++)
        for (int64_t k = m->starts[j]; k < m->starts[j + 1]; k++) {
            int i = m->rows[k];
            b[i] += m->values[k] * known(j);
            if (i != j) b[j] += m->values[k] * known(i);
        }
    return b;
}

static double clock_of(clockid_t id) {
    struct timespec t;
    clock_gettime(id, &t);
    return t.tv_sec + 1e-9 * t.tv_nsec;
}

static Time now(void) { return (Time){ clock_of(CLOCK_PROCESS_CPUTIME_ID), clock_of(CLOCK_MONOTONIC) }; }

static void take_least(Time *least, Time start) {
    Time end = now();
    least->cpu = fmin(least->cpu, end.cpu - start.cpu);
    least->wall = fmin(least->wall, end.wall - start.wall);
}

static long peak_bytes(void) {
    char line[256];
    long kilobytes = 0;
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file)) sscanf(line, "VmHWM: %ld", &kilobytes);
    if (file) fclose(file);
    return 1024 * kilobytes;
}

/* What each solver provides; x is [n][n_rhs], by columns. */
static void prepare(Matrix *m, int threads);
static void analyse(void);
static void factor(void);
static void solve(const double *b, double *x, int n_rhs);
static double factor_bytes(void);

#ifdef USE_PARDISO
#define NAME "PARDISO"
extern void pardisoinit(void *pt, const int *mtype, int *iparm);
extern void pardiso(void *pt, const int *maxfct, const int *mnum, const int *mtype, const int *phase, const int *n,
                    const void *a, const int *ia, const int *ja, int *perm, const int *nrhs, int *iparm,
                    const int *msglvl, void *b, void *x, int *error);
extern void MKL_Set_Num_Threads(int);
extern void MKL_Set_Dynamic(int);
static void *pt[64];
static int iparm[64], *starts, n, *columns;
static double *values;

static void call(int phase, const double *b, double *x, int n_rhs) {
    int one = 1, mtype = 2, quiet = 0, error = 0;
    pardiso(pt, &one, &one, &mtype, &phase, &n, values, starts, columns, NULL, &n_rhs, iparm, &quiet, (void *)b, x, &error);
    if (error) { fprintf(stderr, "PARDISO ends phase %d with %d\n", phase, error); exit(1); }
}
static void prepare(Matrix *m, int threads) {
    /* Columns of the lower triangle are rows of the upper one, which PARDISO takes. */
    n = m->n, columns = m->rows, values = m->values;
    starts = malloc((n + 1) * sizeof *starts);
    for (int i = 0; i <= n; i++) starts[i] = (int)m->starts[i];
    MKL_Set_Dynamic(0);
    MKL_Set_Num_Threads(threads);
    int mtype = 2;
    pardisoinit(pt, &mtype, iparm);
    iparm[0] = 1;   /* these settings */
    iparm[1] = 2;   /* nested dissection of METIS */
    iparm[7] = 0;   /* no refinement: the others do none */
    iparm[17] = -1; /* count the entries of the factor */
    iparm[34] = 1;  /* numbers from 0 */
}
static void analyse(void) { call(11, NULL, NULL, 1); }
static void factor(void) { call(22, NULL, NULL, 1); }
static void solve(const double *b, double *x, int n_rhs) { call(33, b, x, n_rhs); }
static double factor_bytes(void) { return 8.0 * iparm[17]; }
#endif

#ifdef USE_CHOLMOD
#define NAME "CHOLMOD"
#include <suitesparse/cholmod.h>
static cholmod_common common;
static cholmod_sparse matrix;
static cholmod_factor *symbolic;

static void prepare(Matrix *m, int threads) {
    (void)threads; /* those of the BLAS: OPENBLAS_NUM_THREADS */
    cholmod_l_start(&common);
    common.supernodal = CHOLMOD_SUPERNODAL;
    common.nmethods = 1;
    common.method[0].ordering = CHOLMOD_METIS;
    common.postorder = 1;
    int64_t *rows = malloc(m->entries * sizeof *rows);
    for (int64_t k = 0; k < m->entries; k++) rows[k] = m->rows[k];
    matrix = (cholmod_sparse){ .nrow = m->n, .ncol = m->n, .nzmax = m->entries, .p = m->starts, .i = rows,
        .x = m->values, .stype = -1, .itype = CHOLMOD_LONG, .xtype = CHOLMOD_REAL, .dtype = CHOLMOD_DOUBLE,
        .sorted = 1, .packed = 1 };
}
static void analyse(void) {
    if (symbolic) cholmod_l_free_factor(&symbolic, &common);
    symbolic = cholmod_l_analyze(&matrix, &common);
    if (!symbolic || common.status < 0) fail("CHOLMOD does not analyse");
}
static void factor(void) {
    if (!cholmod_l_factorize(&matrix, symbolic, &common) || common.status != CHOLMOD_OK) fail("CHOLMOD does not factor");
}
static void solve(const double *b, double *x, int n_rhs) {
    static cholmod_dense *solution, *y, *e;
    cholmod_dense rhs = { .nrow = matrix.nrow, .ncol = n_rhs, .nzmax = matrix.nrow * n_rhs, .d = matrix.nrow,
        .x = (void *)b, .xtype = CHOLMOD_REAL, .dtype = CHOLMOD_DOUBLE };
    if (!cholmod_l_solve2(CHOLMOD_A, symbolic, &rhs, NULL, &solution, NULL, &y, &e, &common)) fail("CHOLMOD does not solve");
    if (n_rhs == 1) memcpy(x, solution->x, matrix.nrow * sizeof *x); /* the block is not looked at: no copy */
}
static double factor_bytes(void) { return 8.0 * symbolic->xsize; }
#endif

#ifdef USE_MUMPS
#define NAME "MUMPS"
#include <dmumps_c.h>
static DMUMPS_STRUC_C id;
static void job(int number) {
    id.job = number;
    dmumps_c(&id);
    if (id.infog[0] < 0) { fprintf(stderr, "MUMPS ends job %d with %d, %d\n", number, id.infog[0], id.infog[1]); exit(1); }
}
static void prepare(Matrix *m, int threads) {
    (void)threads; /* those of the BLAS and of OpenMP */
    id.par = 1, id.sym = 1, id.comm_fortran = -987654;
    job(-1);
    int *rows = malloc(m->entries * sizeof *rows), *columns = malloc(m->entries * sizeof *columns);
    for (int j = 0; j < m->n; j++)
        for (int64_t k = m->starts[j]; k < m->starts[j + 1]; k++) rows[k] = m->rows[k] + 1, columns[k] = j + 1;
    id.n = m->n, id.nnz = m->entries, id.irn = rows, id.jcn = columns, id.a = m->values;
    id.icntl[0] = id.icntl[1] = id.icntl[2] = -1, id.icntl[3] = 0; /* silent */
    id.icntl[6] = 5;   /* METIS */
    id.icntl[13] = 30; /* percent of room to spare */
    id.icntl[26] = BLOCK; /* all right-hand sides in one block */
}
static void analyse(void) { job(1); }
static void factor(void) { job(2); }
static void solve(const double *b, double *x, int n_rhs) {
    static double *work;
    work = realloc(work, (size_t)id.n * n_rhs * sizeof *work);
    memcpy(work, b, (size_t)id.n * n_rhs * sizeof *work);
    id.rhs = work, id.nrhs = n_rhs, id.lrhs = id.n;
    job(3);
    if (x) memcpy(x, work, (size_t)id.n * n_rhs * sizeof *work);
}
static double factor_bytes(void) { return 8.0 * (id.infog[8] < 0 ? -1e6 * id.infog[8] : id.infog[8]); }
#endif

int main(int argc, char **argv) {
    if (argc != 3) fail("expected MATRIX_DIR and THREADS");
    Matrix m = read_matrix(argv[1]);
    int large = m.n > 300000, threads = atoi(argv[2]);
    double *b = right_side(&m), *x = calloc((size_t)m.n * BLOCK, sizeof *x), *block = malloc((size_t)m.n * BLOCK * sizeof *block);
    for (int j = 0; j < BLOCK; j++) memcpy(block + (size_t)j * m.n, b, m.n * sizeof *b);
    prepare(&m, threads);
    Time least[4];
    for (int i = 0; i < 4; i++) least[i] = (Time){ INFINITY, INFINITY };
    Time start = now();
    analyse();
    take_least(&least[0], start);
    for (int run = 0; run < (large ? 1 : 3); run++) { start = now(); factor(); take_least(&least[1], start); }
    double error = 0;
    for (int run = 0; run < (large ? 5 : 12); run++) {
        start = now();
        solve(b, x, 1);
        take_least(&least[2], start);
    }
    for (int i = 0; i < m.n; i++) error = fmax(error, fabs(x[i] - known(i)));
    for (int run = 0; run < (large ? 2 : 3); run++) { start = now(); solve(block, x, BLOCK); take_least(&least[3], start); }
    const char *parts[] = { "analyse", "factor", "one", "many" };
    printf("solver %s dofs %d threads %d", NAME, m.n, threads);
    for (int i = 0; i < 4; i++) printf(" %s_cpu %.3e %s_wall %.3e", parts[i], least[i].cpu, parts[i], least[i].wall);
    printf(" factor_bytes %.0f peak_bytes %ld error %.1e\n", factor_bytes(), peak_bytes(), error);
    return error < 1e-8 ? 0 : 1;
}
