#define _GNU_SOURCE
#include "engine/worker.h"
#include "engine/solve.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* The parent alone decides about an interrupt; its death ends the worker by SIGKILL. */
static void reset_signals(void)
{
    static const int ignored[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
    struct sigaction action = {.sa_handler = SIG_DFL};
    sigemptyset(&action.sa_mask);
    for (int number = 1; number < NSIG; number++)
        sigaction(number, &action, NULL);
    action.sa_handler = SIG_IGN;
    for (size_t i = 0; i < sizeof ignored / sizeof ignored[0]; i++)
        sigaction(ignored[i], &action, NULL);
    sigprocmask(SIG_SETMASK, &action.sa_mask, NULL);
}

/* Nothing that a foreign library does in a worker can reach the caller's files. */
static void leave_files(int socket)
{
    if (socket > STDERR_FILENO + 1)
        close_range(STDERR_FILENO + 1, (unsigned)socket - 1, 0);
    close_range((unsigned)socket + 1, ~0U, 0); /* first: the caller may have no descriptor left */
    int null = open("/dev/null", O_RDWR);
    if (null < 0 || dup2(null, STDIN_FILENO) < 0 || dup2(null, STDOUT_FILENO) < 0)
        _exit(1);
    if (null > STDERR_FILENO)
        close(null);
}

static bool send_report(int socket, const dea_report *report)
{
    return send(socket, report, sizeof *report, MSG_NOSIGNAL) == (ssize_t)sizeof *report;
}

static ssize_t receive(int socket, void *data, size_t size)
{
    ssize_t got;
    do {
        got = recv(socket, data, size, 0);
    } while (got < 0 && errno == EINTR);
    return got;
}

static void work(const dea_plan *plan, int socket, dea_error *error)
{
    dea_sessions sessions;
    error->message[0] = '\0';
    dea_report report = {.status = dea_sessions_begin(plan, &sessions, error)};
    dea_order order;
    while (send_report(socket, &report) && report.status == DEA_OK && receive(socket, &order, sizeof order) == (ssize_t)sizeof order) {
        error->message[0] = '\0';
        const dea_errand errand = {order.model, order.first, order.count, order.skip};
        report.status = dea_plan_solve(plan, &sessions, &errand, order.points, &report.hands, error);
    }
    dea_sessions_end(&sessions);
}

static _Noreturn void live(const dea_plan *plan, int socket, pid_t parent, dea_error *error)
{
    static const struct rlimit no_core = {0, 0};
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent)
        _exit(0);
    setrlimit(RLIMIT_CORE, &no_core);
    if (socket <= STDERR_FILENO) /* the caller had closed a standard stream */
        socket = fcntl(socket, F_DUPFD, STDERR_FILENO + 1);
    if (socket < 0)
        _exit(1);
    leave_files(socket);
    reset_signals();
    work(plan, socket, error);
    _exit(0);
}

dea_status dea_worker_start(dea_worker *worker, const dea_plan *plan, const dea_worker *others, size_t count, dea_error *error)
{
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return dea_fail(error, DEA_ERROR_ENGINE, "cannot start a worker: %s", strerror(errno));
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    pid_t parent = getpid();
    pid_t pid = fork();
    int reason = errno;
    if (pid == 0) {
        for (size_t i = 0; i < count; i++) {
            if (others[i].state != DEA_WORKER_NONE)
                close(others[i].socket);
        }
        close(ends[0]);
        live(plan, ends[1], parent, worker->error);
    }
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    close(ends[1]);
    if (pid < 0) {
        close(ends[0]);
        return dea_fail(error, DEA_ERROR_ENGINE, "cannot start a worker: %s", strerror(reason));
    }
    worker->pid = pid;
    worker->socket = ends[0];
    worker->state = DEA_WORKER_STARTS;
    return DEA_OK;
}

bool dea_worker_send(const dea_worker *worker, const dea_order *order)
{
    ssize_t sent;
    do {
        sent = send(worker->socket, order, sizeof *order, MSG_NOSIGNAL);
    } while (sent < 0 && errno == EINTR);
    return sent == (ssize_t)sizeof *order;
}

bool dea_worker_receive(const dea_worker *worker, dea_report *report)
{
    return receive(worker->socket, report, sizeof *report) == (ssize_t)sizeof *report;
}

double dea_worker_used(const dea_worker *worker)
{
    clockid_t clock;
    struct timespec used;
    if (clock_getcpuclockid(worker->pid, &clock) != 0 || clock_gettime(clock, &used) != 0)
        return 0.0;
    return (double)used.tv_sec + 1e-9 * (double)used.tv_nsec;
}

bool dea_worker_stopped(const dea_worker *worker)
{
    siginfo_t about = {0};
    return waitid(P_PID, (id_t)worker->pid, &about, WSTOPPED | WNOHANG | WNOWAIT) == 0 && about.si_pid == worker->pid;
}

/* Signals that a process brings upon itself by what it does; all others come from outside. */
static bool is_own_fault(int number)
{
    static const int own[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTRAP, SIGSYS, SIGXCPU, SIGXFSZ, SIGPIPE};
    for (size_t i = 0; i < sizeof own / sizeof own[0]; i++) {
        if (own[i] == number)
            return true;
    }
    return false;
}

static dea_fault describe_end(int ended, char *how, size_t size)
{
    if (WIFSIGNALED(ended)) {
        snprintf(how, size, "the worker was killed by signal %d (%s)", WTERMSIG(ended), strsignal(WTERMSIG(ended)));
        return is_own_fault(WTERMSIG(ended)) ? DEA_FAULT_CRASHED : DEA_FAULT_KILLED;
    }
    snprintf(how, size, "the worker ended by itself with exit status %d", WEXITSTATUS(ended));
    return DEA_FAULT_CRASHED;
}

/* Kills it, if need be; how it ended stands in *@p ended. */
static bool kill_and_reap(pid_t pid, int *ended)
{
    pid_t got;
    kill(pid, SIGKILL);
    do {
        got = waitpid(pid, ended, 0);
    } while (got < 0 && errno == EINTR);
    return got == pid;
}

/* A worker whose socket is closed is exiting, perhaps with a signal that tells why: it gets a moment before it is killed. */
dea_fault dea_worker_reap(dea_worker *worker, char *how, size_t size)
{
    int ended = 0;
    pid_t got = 0;
    for (int tries = 0; tries < 200 && got == 0; tries++) {
        got = waitpid(worker->pid, &ended, WNOHANG);
        if (got == 0)
            usleep(1000);
    }
    const bool reaped = got == worker->pid || (got == 0 && kill_and_reap(worker->pid, &ended));
    worker->pid = 0;
    if (reaped)
        return describe_end(ended, how, size);
    snprintf(how, size, "the worker ended");
    return DEA_FAULT_KILLED;
}

void dea_worker_end(dea_worker *worker)
{
    int ended;
    if (worker->state == DEA_WORKER_NONE)
        return;
    if (worker->pid > 0)
        kill_and_reap(worker->pid, &ended);
    close(worker->socket);
    worker->state = DEA_WORKER_NONE;
}
