import com.sun.management.OperatingSystemMXBean;
import jason.architecture.AgArch;
import jason.asSemantics.ActionExec;
import jason.asSemantics.Agent;
import jason.asSemantics.Message;
import jason.asSemantics.TransitionSystem;
import jason.asSyntax.Literal;
import jason.runtime.Settings;
import jason.util.Config;
import java.io.BufferedReader;
import java.io.IOException;
import java.io.InputStreamReader;
import java.lang.management.ManagementFactory;
import java.nio.file.Files;
import java.nio.file.Path;
import java.util.ArrayList;
import java.util.Arrays;
import java.util.Collection;
import java.util.HashMap;
import java.util.List;
import java.util.Locale;
import java.util.Map;
import java.util.logging.Level;
import java.util.logging.Logger;

/**
 * Jason as a worker: java -cp JASON_JAR:CLASSES JasonWorker FOLDER. The commands are those of worker.py.
 *
 * WRITTEN FROM JASON'S PUBLIC API, NEVER COMPILED OR RUN AGAINST A REAL JAR HERE: the first who has one should compare
 * the number of actions with ours. With `first` after the folder it ends at the first action of the paper's agent.
 *
 * Times are CPU time of the whole process, so the compiler and the collector of the Java machine count too.
 */
public final class JasonWorker {
    private static final OperatingSystemMXBean SYSTEM =
        (OperatingSystemMXBean) ManagementFactory.getOperatingSystemMXBean();

    private final Path folder;
    private final Map<String, Body> bodies = new HashMap<>();
    private final Map<String, Literal> literals = new HashMap<>();

    private JasonWorker(Path folder) {
        this.folder = folder;
    }

    public static void main(String[] arguments) throws Exception {
        Logger.getLogger("").setLevel(Level.SEVERE);
        Config.get().setProperty(Config.START_WEB_MI, "false");
        JasonWorker worker = new JasonWorker(Path.of(arguments[0]));
        if (arguments.length > 1) {
            worker.firstAction();
            System.exit(0);
        }
        BufferedReader commands = new BufferedReader(new InputStreamReader(System.in));
        for (String line = commands.readLine(); line != null; line = commands.readLine()) {
            System.out.println(worker.answer(line.trim().split("\\s+")));
            System.out.flush();
        }
        System.exit(0); // Jason's schedulers keep the machine alive
    }

    private String answer(String[] command) {
        try {
            switch (command[0]) {
                case "script":
                    return script(command[1], Integer.parseInt(command[2]));
                case "each":
                    return each(command[1], Integer.parseInt(command[2]));
                case "goal":
                    return goal(command[1], command[2]);
                default:
                    return error("no command is called " + command[0]);
            }
        } catch (Exception problem) {
            return error(problem.toString());
        }
    }

    private static String error(String text) {
        return "{\"error\": \"" + text.replace('\\', '/').replace('"', '\'').replace('\n', ' ') + "\"}";
    }

    /** What an agent perceives in one cycle, and the goal it is told to achieve (null: none). */
    private record Row(List<Literal> percepts, Literal goal) { }

    private String script(String name, int cycles) throws Exception {
        Body body = body(name);
        List<Row> rows = rows(name, cycles);
        int before = body.acted;
        System.gc();
        long start = SYSTEM.getProcessCpuTime();
        for (Row row : rows) {
            body.cycle(row);
        }
        double cpu = (SYSTEM.getProcessCpuTime() - start) / 1e9;
        return String.format(Locale.ROOT, "{\"cpu_s\": %.9f, \"actions\": %d}", cpu, body.acted - before);
    }

    private String each(String name, int cycles) throws Exception {
        Body body = body(name);
        List<Row> rows = rows(name, cycles);
        long[] times = new long[cycles];
        long[] empty = new long[cycles];
        System.gc();
        for (int cycle = 0; cycle < cycles; cycle++) {
            long start = System.nanoTime();
            body.cycle(rows.get(cycle));
            times[cycle] = System.nanoTime() - start;
        }
        for (int cycle = 0; cycle < cycles; cycle++) {
            long start = System.nanoTime();
            empty[cycle] = System.nanoTime() - start;
        }
        Arrays.sort(times);
        Arrays.sort(empty);
        return String.format(
            Locale.ROOT,
            "{\"p50_us\": %.3f, \"p99_us\": %.3f, \"max_us\": %.3f, \"clock_us\": %.3f}",
            times[cycles / 2] / 1e3, times[(int) (cycles * 99L / 100)] / 1e3, times[cycles - 1] / 1e3,
            empty[cycles / 2] / 1e3);
    }

    private String goal(String name, String goal) throws Exception {
        Body body = new Body(folder.resolve(name + ".asl"));
        Row first = new Row(null, Literal.parseLiteral(goal));
        Row nothing = new Row(null, null);
        System.gc();
        long start = SYSTEM.getProcessCpuTime();
        body.cycle(first);
        while (body.acted == 0) {
            body.cycle(nothing);
        }
        return String.format(Locale.ROOT, "{\"cpu_s\": %.9f}", (SYSTEM.getProcessCpuTime() - start) / 1e9);
    }

    private void firstAction() throws Exception {
        Body body = body("paper");
        for (Row row : rows("paper", 1000)) {
            body.cycle(row);
            if (body.acted > 0) {
                return;
            }
        }
    }

    private Body body(String name) throws Exception {
        if (!bodies.containsKey(name)) {
            bodies.put(name, new Body(folder.resolve(name + ".asl")));
        }
        return bodies.get(name);
    }

    /** The script from its start, again and again, with a list of its own for every cycle: Jason takes from it. */
    private List<Row> rows(String name, int cycles) throws IOException {
        List<String> lines = Files.readAllLines(folder.resolve(name + ".script"));
        List<Row> rows = new ArrayList<>(cycles);
        for (int cycle = 0; cycle < cycles; cycle++) {
            String[] fields = lines.get(cycle % lines.size()).split("\t", -1);
            List<Literal> percepts = new ArrayList<>();
            for (String percept : fields[0].split(" ")) {
                if (!percept.isEmpty()) {
                    percepts.add(literals.computeIfAbsent(percept, Literal::parseLiteral));
                }
            }
            rows.add(new Row(percepts, fields[1].isEmpty() ? null : Literal.parseLiteral(fields[1])));
        }
        return rows;
    }

    /** A body whose actions succeed at once and which perceives what it is given. */
    private static final class Body extends AgArch {
        private static final long serialVersionUID = 1L;

        private int acted;
        private transient List<Literal> percepts;
        private final TransitionSystem mind;

        Body(Path program) throws Exception {
            Agent agent = new Agent();
            mind = new TransitionSystem(agent, null, new Settings(), this);
            agent.initAg();
            agent.loadInitialAS(program.toString());
        }

        void cycle(Row row) {
            percepts = row.percepts();
            if (row.goal() != null) {
                mind.getC().addMsg(new Message("achieve", "user", getAgName(), row.goal()));
            }
            mind.reasoningCycle();
        }

        @Override
        public Collection<Literal> perceive() {
            return percepts; // null: nothing new
        }

        @Override
        public void act(ActionExec action) {
            acted++;
            action.setResult(true);
            actionExecuted(action);
        }

        @Override
        public String getAgName() {
            return "mail";
        }

        @Override
        public boolean isRunning() {
            return true;
        }

        @Override
        public boolean canSleep() {
            return false;
        }
    }
}
