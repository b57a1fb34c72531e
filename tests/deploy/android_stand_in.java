// As much of Android as Launcher.smali touches, so that a JVM verifies and runs the launcher. It prints what is asked of it.
// test_android.py splits this at the lines that name a file.

// android/app/Activity.java
package android.app;
import android.content.*;
import android.content.pm.PackageManager;
import android.os.Bundle;
public class Activity {
    public Intent intent;
    protected void onCreate(Bundle saved) {}
    protected void onRestart() {}
    protected void onDestroy() {}
    public Intent getIntent() { return intent; }
    public PackageManager getPackageManager() { return new PackageManager(); }
    public boolean bindService(Intent service, ServiceConnection connection, int flags) {
        System.out.println("bind " + service.pack + " " + flags);
        return !Phone.session.equals("unbindable");
    }
    public void unbindService(ServiceConnection connection) { System.out.println("unbind"); }
    public void startActivity(Intent intent) { System.out.println("open " + intent); }
    public void finish() { System.out.println("finish"); }
}

// android/app/Phone.java
package android.app;
import java.util.List;
public class Phone {
    public static String defaultBrowser, session;
    public static List<String> trusting;

    /** The default browser; all that support Trusted Web Activities; how they answer; the state; the address asked for. */
    public static void main(String[] words) throws Exception {
        defaultBrowser = words[0];
        trusting = words[1].isEmpty() ? List.of() : List.of(words[1].split(","));
        session = words[2];
        var launcher = (Activity) Class.forName("campus.mail.Launcher").getConstructor().newInstance();
        launcher.intent = new android.content.Intent("android.intent.action.MAIN");
        if (words.length > 4) launcher.intent = new android.content.Intent("android.intent.action.VIEW", android.net.Uri.parse(words[4]));
        launcher.onCreate(words[3].equals("saved") ? new android.os.Bundle() : null);
        var connection = (android.content.ServiceConnection) launcher;
        if (session.equals("null")) connection.onNullBinding(null);
        for (int i = 0; i < 2 && List.of("yes", "no", "dead").contains(session); i++) {
            connection.onServiceConnected(null, new android.os.Service());  // the second time after a crash of the browser
            connection.onServiceDisconnected(null);
        }
        System.out.println("back");
        launcher.onRestart();
        launcher.onDestroy();
    }
}

// android/content/ComponentName.java
package android.content;
public class ComponentName {}

// android/content/Intent.java
package android.content;
import android.net.Uri;
import android.os.Bundle;
public class Intent {
    public String action, category, pack;
    public Uri data;
    public Bundle extras;
    public Intent selector;
    public Intent(String action) { this.action = action; }
    public Intent(String action, Uri data) { this.action = action; this.data = data; }
    public Intent addCategory(String category) { this.category = category; return this; }
    public Intent setPackage(String pack) { this.pack = pack; return this; }
    public Intent putExtras(Bundle extras) { this.extras = extras; return this; }
    public void setSelector(Intent selector) { this.selector = selector; }
    public String getDataString() { return data == null ? null : data.text; }
    public String toString() {
        return action + " " + getDataString() + (pack == null ? "" : " in " + pack)
            + (extras == null ? "" : " with " + extras.values) + (selector == null ? "" : " as " + selector + " " + selector.category);
    }
}

// android/content/ServiceConnection.java
package android.content;
public interface ServiceConnection {
    void onServiceConnected(ComponentName name, android.os.IBinder service);
    void onServiceDisconnected(ComponentName name);
    default void onNullBinding(ComponentName name) {}
}

// android/content/pm/ActivityInfo.java
package android.content.pm;
public class ActivityInfo { public String packageName; }

// android/content/pm/PackageManager.java
package android.content.pm;
import android.app.Phone;
import android.content.Intent;
public class PackageManager {
    public ResolveInfo resolveActivity(Intent intent, int flags) {
        return Phone.defaultBrowser.isEmpty() ? null : new ResolveInfo(Phone.defaultBrowser);
    }
    public ResolveInfo resolveService(Intent intent, int flags) {
        if (!intent.action.equals("android.support.customtabs.action.CustomTabsService")) return null;
        if (!intent.category.equals("androidx.browser.trusted.category.TrustedWebActivities")) return null;
        for (String one : Phone.trusting) if (intent.pack == null || intent.pack.equals(one)) return new ResolveInfo(one);
        return null;
    }
}

// android/content/pm/ResolveInfo.java
package android.content.pm;
public class ResolveInfo {
    public ActivityInfo activityInfo = new ActivityInfo();
    public ServiceInfo serviceInfo = new ServiceInfo();
    public ResolveInfo(String name) { activityInfo.packageName = name; serviceInfo.packageName = name; }
}

// android/content/pm/ServiceInfo.java
package android.content.pm;
public class ServiceInfo { public String packageName; }

// android/net/Uri.java
package android.net;
public class Uri {
    public String text;
    public static Uri parse(String text) { Uri uri = new Uri(); uri.text = text; return uri; }
}

// android/os/Binder.java
package android.os;
public class Binder implements IBinder {
    protected boolean onTransact(int code, Parcel data, Parcel reply, int flags) { return false; }
    public boolean transact(int code, Parcel data, Parcel reply, int flags) { return onTransact(code, data, reply, flags); }
    public String toString() { return "our callback"; }
}

// android/os/Bundle.java
package android.os;
public class Bundle {
    public java.util.Map<String, Object> values = new java.util.TreeMap<>();
    public void putBinder(String name, IBinder value) { values.put(name, value); }
    public void putBoolean(String name, boolean value) { values.put(name, value); }
}

// android/os/IBinder.java
package android.os;
public interface IBinder {
    boolean transact(int code, Parcel data, Parcel reply, int flags) throws RemoteException;
}

// android/os/Parcel.java
package android.os;
public class Parcel {
    public java.util.List<Object> written = new java.util.ArrayList<>();
    public static Parcel obtain() { return new Parcel(); }
    public void writeInterfaceToken(String name) { written.add(name); }
    public void writeStrongBinder(IBinder binder) { written.add(binder); }
    public void writeNoException() { written.add(0); }
    public void readException() { if (!written.remove(0).equals(0)) throw new SecurityException(); }
    public int readInt() { return (Integer) written.remove(0); }
    public void recycle() { written = null; }
}

// android/os/RemoteException.java
package android.os;
public class RemoteException extends Exception {}

// android/os/Service.java
package android.os;
public class Service implements IBinder {
    public boolean transact(int code, Parcel data, Parcel reply, int flags) throws RemoteException {
        System.out.println("ask " + code + " " + data.written);
        if (android.app.Phone.session.equals("dead")) throw new RemoteException();
        Parcel answered = new Parcel();
        if (!((IBinder) data.written.get(1)).transact(99, new Parcel(), answered, 0)) throw new AssertionError();
        if (!((IBinder) data.written.get(1)).transact(99, new Parcel(), null, 1)) throw new AssertionError();
        answered.readException();
        reply.writeNoException();
        reply.written.add(android.app.Phone.session.equals("yes") ? 1 : 0);
        return true;
    }
}
